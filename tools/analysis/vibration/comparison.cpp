// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/comparison.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/headroom.hpp"
#include "tools/run/take_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace tactus::analysis {

namespace {

/// Level gap, dB: the part of the reference's level that the actuator cannot reach at its limits; without an actuator,
/// the missing level of the output as played.
double level_gap(const CompareSettings& settings, const signal::Comparison& c, double peak) {
    if (settings.actuator.empty()) return c.gain_db;
    const vibration::ActuatorModel& model = vibration::find_actuator(settings.actuator);
    const vibration::Actuator actuator(model, settings.mass, 48000.0);
    double square = 0.0;
    for (std::size_t k = 0; k < c.reference_density.size(); ++k) {
        const double f = static_cast<double>(k) * c.step;
        if (f < c.lowest || f > c.highest) continue;
        square += c.reference_density[k] * c.step / std::pow(actuator.gain(f), 2);
    }
    // Assumes the crest factor of the reference.
    const double needed = std::sqrt(square) * peak / c.reference_rms;
    const double limit = vibration::voltage_within(model.voltage_limit, model.current_limit, model.resistance);
    return std::max(0.0, 20.0 * std::log10(needed / limit));
}

/// Hann segments of about 60 ms: resolves lines 25 Hz apart, and strokes of a hand.
signal::Spectrogram spectrogram_of(const signal::Take& take) {
    const auto segment = static_cast<std::size_t>(std::llround(0.06 * take.rate / 2.0)) * 2;
    signal::Spectrogram spectrogram(std::max<std::size_t>(segment, 16), take.rate);
    const signal::Take::Blocks blocks = take.open();
    for (std::span<const double> block = blocks(); !block.empty(); block = blocks()) spectrogram.push(block);
    return spectrogram;
}

/// Pairs of channels (from 1; 0: the mean of all) of the reference and the output; the first pair is the strongest.
std::vector<std::pair<int, int>> compared_channels(const CompareSettings& settings, std::vector<std::string>& notes) {
    if (settings.channel) return {{*settings.channel, *settings.channel}};
    const run::ChannelLevels r = run::channel_levels(settings.reference, settings.logs[0], settings.stretches[0]),
                             d = run::channel_levels(settings.output, settings.logs[1], settings.stretches[1]);
    const std::size_t first = r.strongest();
    const auto pair_of = [](std::size_t a, std::size_t b) {
        return std::pair(static_cast<int>(a) + 1, static_cast<int>(b) + 1);
    };
    if (settings.axes == Axes::vector) {
        if (r.names.size() != d.names.size())
            throw Error(fmt::format("{} has {} channels and {} has {}: --axes vector needs equally many",
                                    settings.reference.string(), r.names.size(), settings.output.string(),
                                    d.names.size()));
        std::vector<std::pair<int, int>> all{pair_of(first, first)};
        for (std::size_t i = 0; i < r.names.size(); ++i)
            if (i != first) all.push_back(pair_of(i, i));
        if (all.size() > 1)
            notes.push_back(
                fmt::format("spectra are the root sum of squares of {} channels; what is compared over "
                            "time is channel {}",
                            all.size(), r.names[first]));
        return all;
    }
    std::size_t second = 0;
    if (d.names.size() > 1) {
        const auto named = std::ranges::find(d.names, r.names[first]);
        second = named != d.names.end() ? static_cast<std::size_t>(named - d.names.begin()) : first;
        if (second >= d.names.size())
            throw Error(
                fmt::format("{}: has no channel like channel {} of the reference, its strongest; choose with "
                            "--channel",
                            settings.output.string(), r.names[first]));
    }
    if (r.names.size() > 1 || d.names.size() > 1)
        notes.push_back(fmt::format("compared: channel {} of the reference{}, channel {} of the output", r.names[first],
                                    r.names.size() > 1 ? ", its strongest" : "", d.names[second]));
    return {pair_of(first, second)};
}

}  // namespace

const char* touch_unit(signal::ThresholdUnit unit) {
    return unit == signal::ThresholdUnit::displacement   ? "displacement"
           : unit == signal::ThresholdUnit::acceleration ? "acceleration"
                                                         : "none";
}

signal::ThresholdUnit touch_of(std::string_view name) {
    return name == "none"           ? signal::ThresholdUnit::none
           : name == "acceleration" ? signal::ThresholdUnit::acceleration
                                    : signal::ThresholdUnit::displacement;
}

void compare_takes(ComparedPair& pair, const signal::Take& reference, const signal::Take& output,
                   const signal::ComparisonOptions& options, bool pictures) {
    pair.touch = options.touch;
    pair.comparison = signal::compare(reference, output, options);
    if (pictures)
        for (const signal::Take* take : {&reference, &output}) pair.spectrograms.push_back(spectrogram_of(*take));
}

ComparedPair compare_files(const CompareSettings& settings) {
    ComparedPair o;
    o.reference = settings.reference;
    o.output = settings.output;
    o.thresholds = settings.thresholds;
    o.touch = settings.touch;
    o.plotted = settings.plotted;
    o.actuator_known = !settings.actuator.empty();
    const std::vector<std::pair<int, int>> channels = compared_channels(settings, o.notes);
    const auto open = [&](bool is_output, int channel) {
        return run::TakeFile({is_output ? settings.output : settings.reference, is_output ? "output" : "reference",
                              settings.logs[is_output ? 1 : 0],
                              is_output ? settings.output_scale : settings.reference_scale, channel,
                              settings.stretches[is_output ? 1 : 0]});
    };
    const run::TakeFile reference = open(false, channels.front().first);
    const run::TakeFile output = open(true, channels.front().second);
    signal::ComparisonOptions options{.touch = o.touch, .longest_delay = settings.longest_delay};
    std::vector<std::unique_ptr<run::TakeFile>> others;
    for (std::size_t i = 1; i < channels.size(); ++i) {
        others.push_back(std::make_unique<run::TakeFile>(open(false, channels[i].first)));
        options.reference_axes.push_back(others.back()->take());
        others.push_back(std::make_unique<run::TakeFile>(open(true, channels[i].second)));
        options.output_axes.push_back(others.back()->take());
    }
    try {
        compare_takes(o, reference.take(), output.take(), options, settings.pictures);
    } catch (const Error& error) {
        throw Error(
            fmt::format("{} and {}: {}", settings.reference.string(), settings.output.string(), error.message()));
    }
    o.stretches = {reference.stretch(), output.stretch()};
    if (!settings.stretches[0].is_whole() || !settings.stretches[1].is_whole())
        o.notes.push_back(fmt::format("compared: {} of the reference, {} of the output", o.stretches[0].text(),
                                      o.stretches[1].text()));
    for (const run::TakeFile* take : {&reference, &output})
        o.notes.insert(o.notes.end(), take->notes().begin(), take->notes().end());
    if (reference.is_calibrated() != output.is_calibrated())
        o.notes.push_back(fmt::format("only the {} states its unit: the level gap compares different quantities",
                                      reference.is_calibrated() ? "reference" : "output"));
    if (std::abs(reference.rate() / output.rate() - 1.0) > 1e-3)
        o.notes.push_back(
            fmt::format("sampled at {} and {}", readable(reference.rate(), "Hz", 6), readable(output.rate(), "Hz", 6)));
    if (o.plotted && o.plotted->first >= o.comparison.end)
        throw Error(fmt::format("--band {}:{} Hz: the spectra that are compared end at {}", plain(o.plotted->first, 6),
                                plain(o.plotted->second, 6), readable(o.comparison.end, "Hz", 6)));
    if (o.comparison.highest < 1000.0)
        o.notes.push_back(fmt::format("judged from {:.0f} to {:.0f} Hz: what both can be trusted in",
                                      o.comparison.lowest, o.comparison.highest));
    for (const auto& [name, inside] :
         {std::pair("reference", o.comparison.reference_inside), std::pair("output", o.comparison.output_inside)})
        if (inside > 0.0 && inside < 0.9) {
            o.not_judged = std::max(o.not_judged, 1.0 - inside);
            o.notes.push_back(
                fmt::format("{:.0f} % of the power of the {} lies outside of {:.0f} to {:.0f} Hz and is not judged",
                            100.0 * (1.0 - inside), name, o.comparison.lowest, o.comparison.highest));
        }
    for (const auto& [name, hz] : {std::pair("reference", o.comparison.reference_hum_hz),
                                   std::pair("output", o.comparison.output_hum_hz)})
        if (hz > 0.0)
            o.notes.push_back(
                fmt::format("{:.2f} Hz in the {} is an order of the mains, mains hum or a machine: its orders are not "
                            "judged; a take of the saw 0.5 to 3 % faster or slower, as reference or output, decides",
                            hz, name));
    o.level_gap_db = level_gap(settings, o.comparison, reference.peak());
    o.verdict = judge(o.comparison, o.level_gap_db, settings.thresholds);
    return o;
}

}  // namespace tactus::analysis

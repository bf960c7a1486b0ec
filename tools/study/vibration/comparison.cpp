// SPDX-License-Identifier: Apache-2.0
#include "tools/study/vibration/comparison.hpp"

#include "dsp/core/error.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/headroom.hpp"
#include "tools/session/take_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::study {

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

}  // namespace

const char* touch_unit(signal::ThresholdUnit unit) {
    return unit == signal::ThresholdUnit::displacement   ? "displacement"
           : unit == signal::ThresholdUnit::acceleration ? "acceleration"
                                                         : "none";
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
    o.actuator_known = !settings.actuator.empty();
    const session::TakeFile reference(
        {settings.reference, "reference", settings.logs[0], settings.reference_scale, settings.channel});
    const session::TakeFile output(
        {settings.output, "output", settings.logs[1], settings.output_scale, settings.channel});
    try {
        compare_takes(o, reference.take(), output.take(), {.touch = o.touch, .longest_delay = settings.longest_delay},
                      settings.pictures);
    } catch (const Error& error) {
        throw Error(
            fmt::format("{} and {}: {}", settings.reference.string(), settings.output.string(), error.message()));
    }
    for (const session::TakeFile* take : {&reference, &output})
        o.notes.insert(o.notes.end(), take->notes().begin(), take->notes().end());
    if (std::abs(reference.rate() / output.rate() - 1.0) > 1e-3)
        o.notes.push_back(fmt::format("sampled at {:.6g} and {:.6g} Hz", reference.rate(), output.rate()));
    if (o.comparison.highest < 1000.0)
        o.notes.push_back(
            fmt::format("the recording with the lower rate is limited to {:.0f} Hz", o.comparison.highest));
    o.level_gap_db = level_gap(settings, o.comparison, reference.peak());
    o.verdict = judge(o.comparison, o.level_gap_db, settings.thresholds);
    return o;
}

}  // namespace tactus::study

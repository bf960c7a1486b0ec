// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/spectrum_analysis.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/signal/filter/integrator.hpp"
#include "dsp/signal/spectrum/band_velocity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

namespace {

constexpr double min_velocity_coverage = 0.9;

signal::WelchSettings psd_settings(const SpectrumSettings& settings, double rate, std::size_t frames) {
    signal::WelchSettings welch;
    welch.rate = rate;
    welch.segment =
        std::min(settings.segment.value_or(signal::suggested_segment(rate, frames)), std::max<std::size_t>(1, frames));
    welch.overlap =
        std::min(welch.segment - 1, static_cast<std::size_t>(settings.overlap * static_cast<double>(welch.segment)));
    welch.window = settings.window;
    welch.detrend = settings.detrend;
    welch.averaging = settings.averaging;
    return welch;
}

/// Integrates a channel of an acceleration in m/s², less its mean.
class ChannelIntegration {
public:
    ChannelIntegration(const SpectrumSettings& settings, double rate, double si, double mean)
        : stages_(static_cast<std::size_t>(settings.integrations), signal::Integrator(settings.high_pass, rate)),
          si_(si),
          mean_(mean) {}
    void operator()(std::vector<double>& samples) {
        for (double& x : samples) {
            x = si_ * (x - mean_);
            for (signal::Integrator& stage : stages_) x = stage(x);
        }
    }
    void reset() {
        for (signal::Integrator& stage : stages_) stage.reset();
    }

private:
    std::vector<signal::Integrator> stages_;
    double si_, mean_;
};

/// Of the integral of an acceleration. Throws Error for another quantity.
sound::Calibration integrated(const sound::Calibration& recorded, const SpectrumSettings& settings,
                              const std::filesystem::path& file) {
    if (settings.integrations == 0) return recorded;
    if (!recorded.known || !recorded.is_acceleration)
        throw Error(fmt::format("{}: --integrate needs a calibrated acceleration, not {}; state it with --calibration",
                                file.string(), recorded.known ? recorded.unit : "an uncalibrated record"));
    sound::Calibration out;
    out.known = true;
    out.unit = settings.integrations == 1 ? "m/s" : "m";
    return out;
}

double usable_of(const AnalysedFile& file) {
    return file.log ? std::min(0.5 * file.rate, file.log->usable) : 0.5 * file.rate;
}

/// Whether a velocity is wanted: of a calibrated acceleration.
bool has_machine_velocity(const AnalysedFile& file) {
    return !file.only_psd && file.recorded.known && file.recorded.is_acceleration;
}

/// One per channel; none without a velocity, or if the record does not reach the upper limit of the band.
std::vector<signal::BandVelocity> machine_velocities(const AnalysedFile& file, std::size_t channels) {
    const auto [low, high] = machine_band;
    if (!has_machine_velocity(file) || usable_of(file) < high) return {};
    return std::vector(channels, signal::BandVelocity(low, high, file.rate));
}

/// Sets the velocity of a channel, with a warning if there is none or if it covers a part of the record only.
void set_machine_velocity(AnalysedChannel& channel, const AnalysedFile& file, const signal::BandVelocity* velocity) {
    if (!has_machine_velocity(file)) return;
    const std::string name = fmt::format("velocity {:g} to {:g} Hz", machine_band.first, machine_band.second);
    if (!velocity) {
        channel.warnings.push_back(
            fmt::format("no {}: the record is valid up to {} only", name, readable(usable_of(file), "Hz", 4)));
        return;
    }
    if (!velocity->is_resolved()) {
        channel.warnings.push_back(
            fmt::format("no {}: it needs a stretch of {:g} s without a gap", name, velocity->min_piece()));
        return;
    }
    channel.machine_velocity = file.recorded.si * velocity->rms();
    channel.machine_velocity_coverage = velocity->coverage();
    if (velocity->coverage() < min_velocity_coverage)
        channel.warnings.push_back(fmt::format(
            "the {} covers {:.0f} % of the record: not its ends, the 0.1 s beside gaps and stretches shorter "
            "than {:g} s",
            name, 100.0 * velocity->coverage(), velocity->min_piece()));
}

std::vector<std::string> warnings_of(const signal::VibrationReport& report, const AnalysedFile& file,
                                     std::size_t channel) {
    std::vector<std::string> warnings;
    if (file.only_psd) return warnings;
    const signal::Level& level = report.level;
    if (level.largest() == 0.0) warnings.push_back("the channel is silent");
    else if (level.rms() <= 1e-12 * level.largest())
        warnings.push_back("the channel is constant: there is no vibration");
    if (level.clipped() > 0)
        warnings.push_back(fmt::format(
            "clipped: {} samples in runs at the limit ({:.3g} %); peaks and high orders are wrong", level.clipped(),
            100.0 * static_cast<double>(level.clipped()) / static_cast<double>(level.count())));
    if (file.log && file.log->at_limit[channel] > 0)
        warnings.push_back(fmt::format(
            "clipped: {} rows at the ends of 16 bits ({:.3g} %); peaks and high orders are wrong",
            file.log->at_limit[channel],
            100.0 * static_cast<double>(file.log->at_limit[channel]) / static_cast<double>(file.log->rows)));
    if (report.lines.effective_segments < 4.0)
        warnings.push_back(fmt::format("short: only {} segments; noise levels are uncertain by {:.1f} dB",
                                       report.lines.segments, 4.34 * report.lines.relative_deviation()));
    if (const signal::FundamentalEstimate& found = report.fundamental; found.frequency > 0.0 && !found.is_certain()) {
        const std::string periods = fmt::format("the record has {:.0f} periods", found.periods);
        if (found.may_be_hum)
            warnings.push_back(
                fmt::format("{:.1f} Hz is an order of the mains, mains hum or a machine; a record with the machine off "
                            "shows the hum",
                            found.frequency));
        else if (found.rivals.empty())
            warnings.push_back(fmt::format("cannot tell whether {:.1f} Hz is the fundamental or a multiple of it: {}",
                                           found.frequency, periods));
        else
            warnings.push_back(fmt::format("cannot tell {:.1f} from {:.1f} Hz: {}", found.frequency,
                                           found.rivals.front().frequency, periods));
    }
    if (report.fundamental.frequency > 0.0 && !report.fundamental.steady)
        warnings.push_back(
            fmt::format("the rate varies from {:.1f} to {:.1f} Hz: lines are smeared; use 'tactus orders'",
                        report.fundamental.low, report.fundamental.high));
    return warnings;
}

}  // namespace

double band_deviation(const signal::Band& band, const signal::Spectrum& spectrum) {
    const double bins = std::max(1.0, (band.high - band.low) / spectrum.noise_bandwidth);
    return std::hypot(10.0 / std::log(10.0) * spectrum.relative_deviation() / std::sqrt(bins), band.leakage_db);
}

AnalysedFile analyse_file(const std::filesystem::path& file, const SpectrumSettings& wanted,
                          const std::function<void(double)>& progress) {
    sound::RecordReader reader = open_record(file, wanted.record);
    const std::vector<std::size_t> chosen = chosen_channels(reader, file, wanted.record);
    AnalysedFile out;
    out.file = file;
    out.rate = reader.rate();
    out.recorded = reader.calibration();
    out.calibration = integrated(out.recorded, wanted, file);
    out.integrations = wanted.integrations;
    out.high_pass = wanted.integrations > 0 ? wanted.high_pass : 0.0;
    out.only_psd = wanted.only_psd;
    out.log = reader.log();
    out.stretch = reader.stretch();
    out.is_density = wanted.is_density;
    out.envelope = wanted.envelope;
    out.marks = places_of(wanted.marks);
    signal::AnalysisSettings settings;
    settings.psd = out.psd = psd_settings(wanted, reader.rate(), reader.frames());
    std::tie(settings.lowest, settings.highest) = wanted.fundamental;
    if (wanted.envelope) settings.envelope = *wanted.envelope;
    settings.orders = wanted.orders;
    settings.spectrogram = wanted.spectrogram;
    settings.only_psd = wanted.only_psd;
    settings.octave_filters = wanted.octave_filters;
    std::vector<signal::VibrationAnalysis> analyses;
    try {
        for (std::size_t i = 0; i < chosen.size(); ++i) analyses.emplace_back(settings, reader.frames());
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file.string(), error.message()));
    }
    // The mean first: the bands contain the ends of the record, where a constant part would be a step.
    sound::RecordBlock block;
    std::vector<ChannelIntegration> integrations;
    std::vector<double> integrated_samples;
    if (!wanted.only_psd || wanted.integrations > 0) {
        std::vector<signal::Level> levels(chosen.size());
        while (reader.next(block))
            for (std::size_t i = 0; i < chosen.size(); ++i) levels[i].push(block.channels[chosen[i]]);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (wanted.integrations > 0) integrations.emplace_back(wanted, out.rate, out.recorded.si, levels[i].mean());
            else analyses[i].set_level(levels[i]);
        }
        reader.rewind();
    }
    std::vector<signal::BandVelocity> velocities = machine_velocities(out, chosen.size());
    std::size_t done = 0;
    while (reader.next(block)) {
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            if (block.after_gap) analyses[i].gap();
            if (!velocities.empty()) {
                if (block.after_gap) velocities[i].end_piece();
                velocities[i].push(block.channels[chosen[i]]);
            }
            if (integrations.empty()) {
                analyses[i].push(block.channels[chosen[i]]);
                continue;
            }
            if (block.after_gap) integrations[i].reset();
            integrated_samples = block.channels[chosen[i]];
            integrations[i](integrated_samples);
            analyses[i].push(integrated_samples);
        }
        done += block.size();
        if (progress)
            progress(static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, reader.frames())));
    }
    out.duration = static_cast<double>(done) / out.rate;
    for (signal::BandVelocity& velocity : velocities) velocity.end_piece();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        AnalysedChannel& channel = out.channels.emplace_back();
        channel.name = reader.channels()[chosen[i]];
        channel.report = analyses[i].report();
        channel.marks = levels_at(channel.report.lines, out.marks);
        if (channel.report.envelope_spectrum)
            channel.envelope_marks = levels_at(*channel.report.envelope_spectrum, out.marks);
        signal::Spectrum& psd = channel.report.psd;
        if (!wanted.is_density)
            for (double& power : psd.power) power *= psd.noise_bandwidth;
        // The rows themselves have the level, whatever resampling does near half the rate.
        if (out.log && wanted.integrations == 0) channel.report.level = out.log->levels[chosen[i]];
        channel.warnings = warnings_of(channel.report, out, chosen[i]);
        set_machine_velocity(channel, out, velocities.empty() ? nullptr : &velocities[i]);
    }
    return out;
}

}  // namespace tactus::analysis

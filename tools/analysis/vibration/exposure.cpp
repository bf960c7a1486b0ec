// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/exposure.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

ExposureOperation analyse_exposure(const std::filesystem::path& file, const ExposureSettings& settings, double duration,
                                   const std::function<void(double)>& progress) {
    OpenAcceleration record = open_acceleration(file, settings);
    const sound::RecordReader& reader = record.reader;
    ExposureOperation out;
    out.file = file.string();
    out.stretch = reader.stretch();
    out.rate = reader.rate();
    out.duration = duration;
    out.calibrated = reader.calibration().known;
    out.calibration = reader.calibration();
    out.log = reader.log();
    out.three_axes = record.channels.size() == 3;
    out.band_high = std::min(signal::weighting_h.highest, record.usable);
    double seconds = 0.0;
    for (const WeightedChannel& one : weight_channels(
             record, std::vector<const signal::Weighting*>(record.channels.size(), &signal::weighting_h), progress)) {
        out.axes.push_back(one.name);
        out.weighted.push_back(one.record.by_transform());
        out.filtered.push_back(one.record.by_filter());
        seconds = one.record.seconds();
        out.clipped += one.clipped;
        if (one.clipped > 0)
            out.notes.push_back(
                fmt::format("axis {} is clipped in {} samples: the value is too low", one.name, one.clipped));
    }
    note_lost(out.log, out.notes);
    if (!out.calibrated) out.notes.push_back("uncalibrated: the values are interpreted as m/s^2");
    if (out.band_high < 1250.0)
        out.notes.push_back(
            fmt::format("the record ends at {:.0f} Hz, below 1250 Hz: the values are lower bounds", out.band_high));
    if (!out.three_axes)
        out.notes.push_back(
            fmt::format("{} of three axes: there is no total value a_hv; A(8) and minutes are computed from these axes "
                        "only and are bounds",
                        out.axes.size()));
    if (out.rate < 20000.0)
        out.notes.push_back(
            "below 20 kHz sample rate the filter deviates from the standard by more than 0.5 %; what counts is the "
            "transform of the record, which does not");
    if (seconds < 60.0) out.notes.push_back("the standard requires at least one minute of measurement in total");
    return out;
}

ExposureVerdict judge_exposure(double value, const signal::ExposureLimits& limits, bool is_lower_bound) noexcept {
    if (value > limits.limit) return ExposureVerdict::above_limit;
    if (value > limits.action)
        return is_lower_bound ? ExposureVerdict::at_least_above_action : ExposureVerdict::above_action;
    return is_lower_bound ? ExposureVerdict::cannot_be_judged : ExposureVerdict::below_action;
}

std::optional<double> exposure_of_day(std::span<const ExposureOperation> operations) {
    std::vector<signal::HandArmOperation> day;
    double seconds = 0.0;
    for (const ExposureOperation& one : operations) {
        day.push_back({one.total(), one.duration});
        seconds += one.duration;
    }
    if (seconds > 24.0 * 3600.0) return std::nullopt;
    return signal::daily_exposure(day);
}

}  // namespace tactus::analysis

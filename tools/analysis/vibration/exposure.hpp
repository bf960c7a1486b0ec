// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the hand from records (ISO 5349-1).
#pragma once

#include "dsp/signal/exposure/hand_arm.hpp"
#include "tools/analysis/vibration/weighted_channels.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Work with one tool during a day.
struct ExposureOperation {
    std::string file;
    sound::ReadStretch stretch;
    std::vector<std::string> axes;
    std::vector<double> weighted, filtered;  ///< m/s² rms per axis: by transform, which is used; by filter
    double rate = 0.0, duration = 0.0;       ///< Hz; s per day
    bool calibrated = false, three_axes = false;
    sound::Calibration calibration;
    std::optional<sound::LogFacts> log;
    double band_high = signal::weighting_h.highest;     ///< Hz
    std::vector<std::string> notes;

    double total() const { return signal::vibration_total(weighted); }
    std::size_t clipped = 0;  ///< samples

    /// True when axes or a part of the band are missing, or samples are clipped or lost: values are then lower bounds.
    bool is_lower_bound() const { return band_high < 1250.0 || !three_axes || clipped > 0 || is_incomplete(log); }
};

/// Verdict on the exposure of a day. A lower bound can exceed a limit, but never proves compliance.
enum class ExposureVerdict { below_action, above_action, above_limit, at_least_above_action, cannot_be_judged };

ExposureVerdict judge_exposure(double value, const signal::ExposureLimits& limits, bool is_lower_bound) noexcept;

/// Evaluates a record with the axes as channels. `duration`: contact time per day, s. Calls `progress` with the
/// fraction done. Throws Error.
ExposureOperation analyse_exposure(const std::filesystem::path& file, const ExposureSettings& settings, double duration,
                                   const std::function<void(double)>& progress);

/// A(8) of a day with all tools, m/s²; empty if the durations exceed a day.
std::optional<double> exposure_of_day(std::span<const ExposureOperation> operations);

}  // namespace tactus::analysis

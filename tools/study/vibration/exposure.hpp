// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the hand from records (ISO 5349-1).
#pragma once

#include "dsp/signal/exposure/hand_arm.hpp"
#include "tools/study/vibration/record.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::study {

struct ExposureSettings {
    RecordSettings record;
    bool uncalibrated = false;  ///< take values of a record without calibration as m/s²
};

/// Work with one tool on a day.
struct ExposureOperation {
    std::string file;
    std::vector<std::string> axes;
    std::vector<double> weighted, filtered;  ///< m/s², from the spectrum and from the filter, per axis
    double rate = 0.0, duration = 0.0;       ///< Hz; s per day
    bool calibrated = false, three_axes = false;
    double band_high = signal::hand_arm_highest;     ///< Hz
    std::vector<std::string> notes;

    double total() const { return signal::vibration_total(weighted); }
    /// Values are lower bounds: axes or a part of the band are missing.
    bool is_lower_bound() const { return band_high < 1250.0 || !three_axes; }
};

/// Reads a record, whose channels are the axes. `duration`: of contact per day, s. `progress` is told the share that is
/// done. Throws Error.
ExposureOperation analyse_exposure(const std::filesystem::path& file, const ExposureSettings& settings, double duration,
                                   const std::function<void(double)>& progress);

/// A(8) of a day with all of these, m/s²; none when they take longer than a day.
std::optional<double> exposure_of_day(std::span<const ExposureOperation> operations);

}  // namespace tactus::study

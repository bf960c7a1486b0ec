// SPDX-License-Identifier: Apache-2.0
// Channels of an acceleration record, each with its frequency weighting.
#pragma once

#include "dsp/signal/exposure/weighting.hpp"
#include "tools/analysis/vibration/record.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct ExposureSettings {
    RecordSettings record;
    bool uncalibrated = false;  ///< interpret the values of an uncalibrated record as m/s²
    std::string axes;  ///< whole body: "xyz", the axis of each channel; empty: by the names of the channels
};

/// The record and its channels; `usable` is the upper limit (Hz) of its reliable frequency range.
struct OpenAcceleration {
    sound::RecordReader reader;
    std::vector<std::size_t> channels;
    double usable = 0.0;
};

/// Above this fraction of lost samples a record does not prove that an exposure is low enough.
inline constexpr double max_lost_fraction = 0.01;

/// Of a log whose lost samples are more than that.
bool is_incomplete(const std::optional<sound::LogFacts>& log);
/// Adds a note about them.
void note_lost(const std::optional<sound::LogFacts>& log, std::vector<std::string>& notes);

/// Opens a record of one to three axes. Throws Error if it is not an acceleration or not calibrated.
OpenAcceleration open_acceleration(const std::filesystem::path& file, const ExposureSettings& settings);

struct WeightedChannel {
    std::string name;
    signal::WeightedRecord record;
    std::size_t clipped = 0;  ///< samples
};

/// Weights the channels, in two passes. `weightings`: one per channel. Calls `progress` with the fraction done.
std::vector<WeightedChannel> weight_channels(OpenAcceleration& record,
                                             const std::vector<const signal::Weighting*>& weightings,
                                             const std::function<void(double)>& progress);

}  // namespace tactus::analysis

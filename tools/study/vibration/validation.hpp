// SPDX-License-Identifier: Apache-2.0
// Runs of a patch beside the recordings that its saw plays.
#pragma once

#include "assets/sound/recording_set.hpp"
#include "tools/session/patch_choice.hpp"
#include "tools/study/patch_steady.hpp"
#include "tools/study/vibration/comparison.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

/// One recording at one level, and what the handle made of it.
struct ValidationRun {
    const sound::Recording* recording = nullptr;  ///< of the set
    double level_db = 0.0;                 ///< of the saw, on top of the patch's
    ComparedPair pair;                     ///< the recording and the handle
    std::optional<double> drive_rms, drive_peak;  ///< of the actuator's voltage, V
    std::string failure;                   ///< why it could not be compared

    std::string name() const;       ///< "cutting, 233 Hz, 7 N, -6 dB"
    std::string file_name() const;  ///< "cutting_233Hz_7N_-6dB"
};

struct ValidateSettings {
    session::PatchChoice patch;            ///< beside the recordings that it plays
    std::filesystem::path set;             ///< of recordings
    std::string saw, out_port;             ///< node, NODE.PORT; empty: found in the patch
    std::vector<double> levels{0.0, -6.0}; ///< dB on top of the patch's
    double seconds = 4.0;                  ///< that are compared of each run
    table::Thresholds thresholds;
    signal::ThresholdUnit touch = signal::ThresholdUnit::displacement;
};

struct Validation {
    std::string patch;
    patch::Patch source;
    SawPath path;
    std::shared_ptr<const sound::RecordingSet> set;
    table::Thresholds thresholds;
    std::vector<ValidationRun> runs;
};

/// Reads the patch and the set and lists the runs: every recording at every level. Throws Error.
Validation plan_validation(const ValidateSettings& settings);

/// Renders and compares one of them; with spectrograms when pictures are wanted. Different runs may go on at the same
/// time. Throws Error.
void validate(Validation& validation, std::size_t run, const ValidateSettings& settings, bool pictures);

}  // namespace tactus::study

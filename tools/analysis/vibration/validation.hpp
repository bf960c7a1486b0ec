// SPDX-License-Identifier: Apache-2.0
// Compares runs of a patch with the recordings that its saw plays.
#pragma once

#include "assets/sound/recording_set.hpp"
#include "tools/analysis/patch_steady.hpp"
#include "tools/analysis/vibration/comparison.hpp"
#include "tools/run/patch_choice.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

/// One run: a recording at one level, and the vibration of the handle.
struct ValidationRun {
    const sound::Recording* recording = nullptr;  ///< of the set
    double level_db = 0.0;                 ///< level of the saw relative to the patch
    ComparedPair pair;                     ///< the recording and the handle
    std::optional<double> drive_rms, drive_peak;  ///< actuator voltage, V
    std::string failure;                   ///< reason of a failed comparison; empty: success

    std::string name() const;       ///< "cutting, 233 Hz, 7 N, -6 dB"
    std::string file_name() const;  ///< "cutting_233Hz_7N_-6dB"
};

struct ValidateSettings {
    run::PatchChoice patch;            ///< the patch to validate
    std::filesystem::path set;             ///< the recording set
    std::string saw, out_port;             ///< node, NODE.PORT; empty: found in the patch
    std::vector<double> levels{0.0, -6.0}; ///< dB relative to the patch
    double from = 1.0;  ///< s: start of the compared stretch of each run, after the saw's run-up
    double seconds = 4.0;  ///< compared time of each run
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

/// Renders and compares one run, with spectrograms if requested. Different runs may be computed concurrently. Throws
/// Error.
void validate(Validation& validation, std::size_t run, const ValidateSettings& settings, bool pictures);

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// Fits the model of a saw to its recordings, and cross-validates it with each recording left out.
#pragma once

#include "assets/sound/recording_set.hpp"
#include "assets/sound/saw_model_file.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace tactus::analysis {

struct SawModelSettings {
    std::filesystem::path recordings;  ///< a recording set
    double lowest = 40.0, highest = 1000.0;  ///< Hz: band of the distances
    sound::Stretch stretch;  ///< of each recording, from the start of its file
};

/// Difference between a recording and a model.
struct ModelDistance {
    double log_spectral_db = 0.0;  ///< log-spectral distance of the power densities, levels included
    double level_db = 0.0;         ///< level of the model in the band minus that of the recording
};

struct ModelledRecording {
    const sound::Recording* recording = nullptr;
    ModelDistance fitted;                 ///< by the model of all recordings
    std::optional<ModelDistance> left_out;  ///< by the model of the others; none if there are no others of its state
    bool inner = false;  ///< the others enclose its condition; otherwise the model extrapolates
};

struct SawModelling {
    sound::RecordingSet set;
    sound::SawModelTexts texts;
    vibration::SawModel model;
    std::vector<ModelledRecording> recordings;  // point into `set`
};

/// Throws Error unless the file is a recording set that states every rate and thrust.
SawModelling model_saw(const SawModelSettings& settings);

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// What a live run is asked for.
#pragma once

#include "tools/session/patch_choice.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::session {

struct RunChoice : PatchChoice {
    std::optional<double> seconds;
    double dilate = 1.0;
    std::string audio;         ///< "", "file", "none", "default" or part of a card's name
    double audio_margin = 10;  ///< ms
    std::filesystem::path out, log, record;
    bool overwrite = false;   ///< results that the folder holds
    bool is_further = false;  ///< a run before it in the same window has that folder
    bool keeps_journal = false;  ///< so that recording can begin within the run
    bool edits = true;  ///< take over the patch file when it is saved, and listen to 'set'
    bool json = false;  ///< the summary is wanted as JSON, and nothing is said besides
};

}  // namespace tactus::session

// SPDX-License-Identifier: Apache-2.0
// Options of a live run.
#pragma once

#include "engine/run/options.hpp"
#include "tools/run/patch_choice.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::run {

struct RunChoice : PatchChoice {
    std::optional<double> seconds;
    double dilate = 1.0;
    std::string audio;         ///< "", "file", "none", "default" or a substring of a card's name
    double audio_margin = 10;  ///< ms
    std::filesystem::path out, log, record;
    bool record_values = true;  ///< all values, and not only the first, besides the decisions
    bool overwrite = false;   ///< replace existing results
    bool is_further = false;  ///< an earlier run in the same window uses the folder
    bool keeps_journal = false;  ///< allows recording to start during the run
    bool edits = true;  ///< apply saved edits of the patch file, and accept 'set' and 'trigger'
    bool json = false;  ///< print the summary as JSON and nothing else
    run::TapMaker tap;  ///< where every value of the outputs goes, besides a take; null: nowhere
};

}  // namespace tactus::run

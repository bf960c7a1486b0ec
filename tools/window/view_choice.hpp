// SPDX-License-Identifier: Apache-2.0
// Options of the window.
#pragma once

#include "tools/render/sight_choice.hpp"
#include "tools/run/run_choice.hpp"

#include <filesystem>
#include <string>

namespace tactus::window {

class PictureMeter;

/// Options of the window on a run.
struct ViewChoice {
    bool wanted = false;
    bool keep_running = false;                ///< closing the window does not end the run
    std::filesystem::path script;             ///< file of window commands
    std::filesystem::path reference;          ///< sound file whose spectrum is drawn behind those of the signals
    std::filesystem::path scan;               ///< CT whose slices are shown beside the scene of a plan
    std::string layout;                       ///< "patch", "plan" or "train"; empty: as the patch was seen last
    double scale = 0.0;                       ///< scale of the content, 0: that of the screen
    int width = 1600, height = 1000;          ///< of the window when it opens, pixels
    PictureMeter* meter = nullptr;            ///< told of each picture
    render::SightChoice sight;
};

struct ViewedRunChoice : run::RunChoice {
    ViewChoice view;
};

struct FileViewChoice {
    std::filesystem::path file;  ///< a take, a patch or a plan; empty: the start page
    ViewChoice view;
};

}  // namespace tactus::window

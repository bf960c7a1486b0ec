// SPDX-License-Identifier: Apache-2.0
// What the window is asked for.
#pragma once

#include "tools/picture/scene/sight_choice.hpp"
#include "tools/session/run_choice.hpp"

#include <filesystem>

namespace tactus::view {

/// The window on a run.
struct ViewChoice {
    bool wanted = false;
    bool keep_running = false;                ///< closing the window leaves the run alive
    std::filesystem::path script;             ///< what is done in the window, instead of by hand
    std::filesystem::path reference;          ///< sound file whose spectrum stands behind the signals'
    double scale = 0.0;                       ///< of the window's contents, 0: what the screen says
    picture::SightChoice sight;
};

struct ViewedRunChoice : session::RunChoice {
    ViewChoice view;
};

struct TakeViewChoice {
    std::filesystem::path take;
    ViewChoice view;
};

}  // namespace tactus::view

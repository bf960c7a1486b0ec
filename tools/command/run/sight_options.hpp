// SPDX-License-Identifier: Apache-2.0
// Options of the view of a scene, for pictures and the window.
#pragma once

#include "tools/command/options.hpp"
#include "tools/window/view_choice.hpp"

namespace tactus::command {

/// The options require `what`, unless it is null.
void add_sight_options(VerbOptions& verb, render::SightChoice& choice, const Option* what);
/// Options of the window.
void add_view_options(VerbOptions& verb, window::ViewChoice& choice);

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
// How scenes are looked at, in pictures and in the window.
#pragma once

#include "tools/command/options.hpp"
#include "tools/view/view_choice.hpp"

namespace tactus::command {

/// They need `what`, unless that is null.
void add_sight_options(VerbOptions& verb, picture::SightChoice& choice, const Option* what);
/// Of the window.
void add_view_options(VerbOptions& verb, view::ViewChoice& choice);

}  // namespace tactus::command

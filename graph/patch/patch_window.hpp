// SPDX-License-Identifier: Apache-2.0
// The window layout of a patch, stored in the patch itself. It has no effect on a run:
//
//     [window]
//     layout = "plan"                    # patch, plan or train
//     open   = ["handle"]                # sub-patches whose nodes are shown
//     [window.places]
//     ball = [240, 60]                   # upper left corner of the node within its lane
//     [window.colours]
//     ball = "amber"
//     [window.comments.why]
//     text  = "the wall of the canal"
//     place = [20, 300]
//     size  = [240, 80]
#pragma once

#include "graph/patch/patch.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace toml {
inline namespace v3 {
class node;
}  // namespace v3
}  // namespace toml

namespace tactus::patch {

/// A position in canvas units: pixels at zoom 1.
struct PatchPlace {
    double x = 0.0, y = 0.0;
};

struct PatchComment {
    std::string name, text, colour;
    PatchPlace place, size;
};

struct PatchWindow {
    std::string layout;  ///< empty: not given
    std::vector<std::string> open;
    std::map<std::string, PatchPlace> places;  ///< by node; some nodes may not exist
    std::map<std::string, std::string> colours;
    std::vector<PatchComment> comments;
};

/// The names of colours, in the order of the menu.
const std::vector<std::string>& colour_names();

/// Reads the value of `window`. Adds errors to `problems`. `file` is the name of the patch in messages.
PatchWindow read_window(const toml::node& value, const std::string& file, Problems& problems);

/// Returns the [window] part of a patch's text; empty if the text is not a patch.
PatchWindow window_of(std::string_view text);

}  // namespace tactus::patch

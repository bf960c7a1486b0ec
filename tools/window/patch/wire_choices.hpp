// SPDX-License-Identifier: Apache-2.0
// The wires that a patch could have. No user interface.
#pragma once

#include "tools/window/document/patch_picture.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::window {

struct WireChoice {
    std::string from, to;  ///< "node.port"
    bool drives = false;   ///< a parameter
};
struct WireChoices {
    std::vector<WireChoice> list;
    bool has_more = false;
};

/// Wires into the inputs that have none from every output that suits, then those that drive parameters; at most so many.
WireChoices wire_choices(const PatchPicture& picture, std::size_t most);

}  // namespace tactus::window

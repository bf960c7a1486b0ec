// SPDX-License-Identifier: Apache-2.0
// Gives the nodes of a picture their places, and its wires their routes.
#pragma once

#include "tools/window/document/patch_picture.hpp"

#include <vector>

namespace tactus::window {

/// `orders`: for each lane its nodes, sources before what they feed. Nodes with a place in `window` stand there; the
/// others stand where they would if none had one. `window` may be null.
void arrange(PatchPicture& picture, const std::vector<std::vector<int>>& orders, const patch::PatchWindow* window);

}  // namespace tactus::window

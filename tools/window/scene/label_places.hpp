// SPDX-License-Identifier: Apache-2.0
// Places for the names of points in a picture, so that no name covers another. No user interface.
#pragma once

#include "tools/window/widgets/canvas.hpp"

#include <span>
#include <vector>

namespace tactus::window {

/// A box for each of `wanted`, in the same order: as wanted where that is free, otherwise moved up or down by as little as
/// frees it, inside `within` where it fits. Boxes keep their sizes. What is wanted further up is placed first, so that
/// names seldom change sides while the picture turns. With too many boxes for `within` some overlap.
std::vector<Box> label_places(std::span<const Box> wanted, const Box& within);

}  // namespace tactus::window

// SPDX-License-Identifier: Apache-2.0
// Narrowings drawn at random: is one measured wrongly and not called uncertain?
#pragma once

#include "assets/file/json.hpp"

namespace tactus::bench {

/// Follows `draws` phantoms with a narrowing each: R 1.5 to 6 voxels, over 1.5 to 8 R (30 voxels at most), of 0 to 97 %,
/// noise 0.05 to 0.4 of the contrast, any direction, round or on one side, peaked or flat. Tells how many are off by more
/// than 10 and by more than 15 points of the diameter without being called uncertain, and each of the latter.
file::Json narrowing_search(int draws);
void print_search(const file::Json& row);

}  // namespace tactus::bench

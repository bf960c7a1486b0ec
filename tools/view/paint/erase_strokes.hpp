// SPDX-License-Identifier: Apache-2.0
// The eraser of the painting window.
#pragma once

#include "assets/segment/seeds_file.hpp"

#include <vector>

namespace tactus::view {

/// Removes the parts of strokes whose middle is closer to the eraser's line than its radius and half of their own; what is
/// left of a stroke may become several. Returns false when nothing was there.
bool erase_strokes(std::vector<segment::SeedLabel>& labels, const segment::Stroke& eraser);

/// A position as SEEDS.json holds it: in steps of 0.001 mm, with the bits that reading the file gives.
Vec3 as_filed(const Vec3& position);

}  // namespace tactus::view

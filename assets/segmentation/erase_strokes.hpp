// SPDX-License-Identifier: Apache-2.0
// Editing of strokes by an eraser, for painting with a mouse or a haptic device.
#pragma once

#include "assets/segmentation/seeds_file.hpp"

#include <vector>

namespace tactus::segmentation {

/// Removes the parts of strokes whose centreline is closer to the eraser's line than its radius plus half of their own.
/// The rest of a stroke may be split into several. Returns false if nothing was removed.
bool erase_strokes(std::vector<SeedLabel>& labels, const Stroke& eraser);

/// Rounds a position to that in SEEDS.json: steps of 0.001 mm, with the bits that reading the file gives.
Vec3 as_filed(const Vec3& position);

/// Returns whether a brush of that radius at `point` is far enough from the last point of its stroke to add a point: a
/// quarter of the radius. Smaller steps are not needed, because the line between the points is painted too.
bool is_apart(const Vec3& last, double radius, const Vec3& point);

}  // namespace tactus::segmentation

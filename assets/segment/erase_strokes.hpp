// SPDX-License-Identifier: Apache-2.0
// What a brush does to seeds, painted by a mouse or by a hand.
#pragma once

#include "assets/segment/seeds_file.hpp"

#include <vector>

namespace tactus::segment {

/// Removes the parts of strokes whose middle is closer to the eraser's line than its radius and half of their own; what is
/// left of a stroke may become several. Returns false when nothing was there.
bool erase_strokes(std::vector<SeedLabel>& labels, const Stroke& eraser);

/// A position as SEEDS.json holds it: in steps of 0.001 mm, with the bits that reading the file gives.
Vec3 as_filed(const Vec3& position);

/// Whether a brush of that radius at `point` is far enough from the last point of its stroke for another one: a quarter of the
/// radius. The line between the points is painted, too.
bool is_apart(const Vec3& last, double radius, const Vec3& point);

}  // namespace tactus::segment

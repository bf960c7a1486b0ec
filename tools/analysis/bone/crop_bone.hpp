// SPDX-License-Identifier: Apache-2.0
// Extracts the part of a bone in a box, such as around its cut.
#pragma once

#include "assets/bone/bone.hpp"

#include <string>

namespace tactus::analysis {

/// A box, m, LPS.
struct BoneBox {
    Vec3 low{0.0}, high{0.0};
};

/// Parses "x0:x1,y0:y1,z0:z1" in mm. Throws Error.
BoneBox parse_box(const std::string& text);

/// Returns the box around all samples that lie inside one bone and outside the other, with `margin` m around it. Throws
/// Error if the two bones have different samples, or if they are equal.
BoneBox box_of_cut(const bone::Bone& cut, const bone::Bone& original, double margin = 5e-3);

/// Returns the samples in the box; if `closed`, the surface is closed by a flat face where the box ends in bone. Throws
/// Error if the box contains fewer than 3 samples along an axis.
bone::Bone part_of_bone(const bone::Bone& bone, const BoneBox& box, bool closed);

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// The part of a bone in a box, such as around its cut.
#pragma once

#include "assets/bone/bone.hpp"

#include <string>

namespace tactus::study {

/// A box, m, LPS.
struct BoneBox {
    Vec3 low{0.0}, high{0.0};
};

/// Parses "x0:x1,y0:y1,z0:z1" in mm. Throws Error.
BoneBox parse_box(const std::string& text);

/// The box around all samples that lie inside one bone and outside the other, with `margin` m around it. Throws Error
/// when the two bones do not share their samples, or do not differ.
BoneBox box_of_cut(const bone::Bone& cut, const bone::Bone& original, double margin = 5e-3);

/// The samples in the box; where it ends in bone, the surface is closed by a flat face when `closed`. Throws Error when
/// the box holds fewer than 3 samples along an axis.
bone::Bone part_of_bone(const bone::Bone& bone, const BoneBox& box, bool closed);

}  // namespace tactus::study

// SPDX-License-Identifier: Apache-2.0
// What is measured of a fibula plan whose segments are placed: cut faces, joints, warnings.
#pragma once

#include "dsp/reconstruct/donor_bone.hpp"
#include "dsp/reconstruct/fibula_plan.hpp"
#include "dsp/reconstruct/section.hpp"

#include <array>
#include <vector>

namespace tactus::reconstruct {

/// The two sections of each segment, frame of the donor; empty without a donor.
using Cuts = std::vector<std::array<Section, 2>>;

/// Areas, contact, kerf.
void measure_faces(FibulaPlan& plan, const FibulaInputs& inputs, const Cuts& cuts);
/// Wedges, rolls; `off_bisector`: rad, of the inner planes in the order of the jaw.
void measure_joints(FibulaPlan& plan, const std::vector<double>& off_bisector, const DonorBone& donor);
/// Fills `warnings` from the other measures.
void warn_of(FibulaPlan& plan, const FibulaInputs& inputs, const DonorBone& donor);

}  // namespace tactus::reconstruct

// SPDX-License-Identifier: Apache-2.0
// Measures of a fibula plan with placed segments: cut faces, joints, warnings.
#pragma once

#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/section.hpp"

#include <array>
#include <vector>

namespace tactus::reconstruction {

/// The two sections of each segment, frame of the donor; empty without a donor.
using Cuts = std::vector<std::array<Section, 2>>;

/// Computes areas, contact and kerf.
void measure_faces(FibulaPlan& plan, const FibulaInputs& inputs, const Cuts& cuts);
/// Computes wedges and rolls; `off_bisector`: rad, of the inner planes in the order of the jaw.
void measure_joints(FibulaPlan& plan, const std::vector<double>& off_bisector, const DonorBone& donor);
/// Derives `warnings` from the other measures.
void warn_of(FibulaPlan& plan, const FibulaInputs& inputs, const DonorBone& donor);

}  // namespace tactus::reconstruction

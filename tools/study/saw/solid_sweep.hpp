// SPDX-License-Identifier: Apache-2.0
// Presses every part of a tool into bone at random attitudes: no part may sink in without force.
#pragma once

#include "assets/bone/bone.hpp"

#include <cstdint>

namespace tactus::study {

enum class SolidTool : std::uint8_t { blade, sagittal, burr };

struct SolidSweep {
    double deep = 0.5e-3;  ///< m: a part of the tool that is deeper than this in bone must be felt
    double stiffness = 20e3;  ///< N/m
    std::uint64_t seed = 3;
};

struct SolidSweepResult {
    int poses = 0;
    int pressed = 0;  ///< steps of 0.1 mm with a part deeper than `deep`
    int silent = 0;  ///< of those, without any force
    double greatest_silent = 0.0;  ///< m, depth
    double greatest_step = 0.0;  ///< N: change of the force over 0.1 mm on the way in
    double median_step = 0.0;  ///< N
    int active = 0;  ///< ways in and out, the tool standing still, that gave the hand more than their steps explain
    int held = 0;  ///< poses after which the tool had force outside of the bone, also 2 s later
};

/// `poses` attitudes: a place on the tool goes to a place 3 mm or so below the surface of the bone, straight from outside,
/// in steps of 0.1 mm, and out again. The tool does not cut. Deterministic.
SolidSweepResult run_solid_sweep(SolidTool tool, const bone::Bone& bone, int poses, const SolidSweep& sweep = {});

}  // namespace tactus::study

// SPDX-License-Identifier: Apache-2.0
// Presses every part of a tool into bone at random attitudes, to verify that no part can penetrate without force.
#pragma once

#include "assets/bone/bone.hpp"

#include <cstdint>

namespace tactus::analysis {

enum class SolidTool : std::uint8_t { blade, sagittal, burr };

struct SolidSweep {
    double deep = 0.5e-3;  ///< m: a part of the tool that is deeper than this in bone must cause a force
    double stiffness = 20e3;  ///< N/m
    std::uint64_t seed = 3;
};

struct SolidSweepResult {
    int poses = 0;
    int pressed = 0;  ///< steps of 0.1 mm with a part deeper than `deep`
    int silent = 0;  ///< of those, steps without any force
    double greatest_silent = 0.0;  ///< m, largest depth of such a step
    double greatest_step = 0.0;  ///< N: largest change of the force over 0.1 mm on the way in
    double median_step = 0.0;  ///< N
    int active = 0;  ///< paths in and out that gave the hand more energy than their steps explain, tool off
    int held = 0;  ///< poses after which the tool had force outside of the bone, even 2 s later
};

/// Tests `poses` attitudes: a point of the tool moves to a position about 3 mm below the surface of the bone, straight
/// from outside, in steps of 0.1 mm, and out again. The tool does not cut. Deterministic.
SolidSweepResult run_solid_sweep(SolidTool tool, const bone::Bone& bone, int poses, const SolidSweep& sweep = {});

}  // namespace tactus::analysis

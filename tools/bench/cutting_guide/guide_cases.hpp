// SPDX-License-Identifier: Apache-2.0
// Random plans on bones of several shapes, for guides that nothing was tuned on.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::bench {

struct NamedBone {
    std::string name;
    geometry::TriangleSurface surface;  ///< m, LPS, chin of a jaw towards -y
};

/// A whole jaw by formula, and a part of one with its nerve canal, from a distance field.
std::vector<NamedBone> bundled_jaws();

struct RandomGuide {
    reconstruction::FibulaInputs inputs;  ///< with surfaces
    analysis::GuideChoice choice;
};

/// One to four segments between tilted planes at random places of the jaw, with a random blade, clearance, slot kind,
/// thickness, wrap, depth, offset and approach. `for_jaw`: one cut of the jaw, or both; else the cuts of the fibula.
/// The same number gives the same guide. Throws Error if no valid plan is found in 200 attempts.
RandomGuide random_guide(std::uint64_t number, const geometry::TriangleSurface& jaw, bool for_jaw, double voxel);

}  // namespace tactus::bench

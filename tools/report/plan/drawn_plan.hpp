// SPDX-License-Identifier: Apache-2.0
// What the parts of a plan's report draw and tell: the fragments with their surfaces, the state, the vessels.
#pragma once

#include "assets/mesh/mesh.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/analysis/plan/plan_vessels.hpp"
#include "tools/render/labelled_picture.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

struct DrawnPlan {
    plan::CasePlan plan;
    plan::PlanState state{fit::Arrangement(0), {}, {}, std::nullopt};
    std::vector<analysis::CaseFragment> fragments;
    std::vector<mesh::Mesh> meshes;  ///< of the fragments, in the frame of their scan; m
    std::vector<std::optional<double>> to_healthy;  ///< m, per fragment
    std::vector<analysis::VesselClearance> vessels;

    const std::string& name(std::size_t n) const { return plan.fragments[n].name; }
    Pose pose(std::size_t n) const { return state.arrangement.pose(static_cast<int>(n)); }
    bool is_shown(std::size_t n) const { return !state.arrangement.is_hidden(static_cast<int>(n)); }
    /// Middle of a fragment's surface points in the frame of its scan, m.
    Vec3 middle(std::size_t n) const;
};

/// sRGB of an artery or a vein.
const Vec3& colour_of(const reconstruction::FlapVessel& vessel);

/// A mesh at a pose, in one colour (sRGB).
display::PictureMesh placed(const mesh::Mesh& mesh, const Pose& pose, const Vec3& colour);

}  // namespace tactus::report

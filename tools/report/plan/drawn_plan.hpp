// SPDX-License-Identifier: Apache-2.0
// A plan as its report draws it: the fragments with their surfaces, the state, the vessels, the gaps.
#pragma once

#include "assets/mesh/mesh.hpp"
#include "dsp/fit/registration/registration.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/analysis/plan/plan_vessels.hpp"
#include "tools/render/labelled_picture.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

struct DrawnPlan {
    plan::CasePlan plan;
    plan::PlanState state{fit::Arrangement(0), {}, {}, std::nullopt};
    std::vector<analysis::CaseFragment> fragments;
    std::vector<mesh::Mesh> meshes;  ///< of the fragments, in the frame of their scan; m
    std::vector<std::optional<double>> to_healthy;  ///< m, per fragment: the median distance where it is planned
    std::optional<fit::RegistrationTarget> healthy;  ///< in the frame of the case
    std::vector<analysis::VesselClearance> vessels;
    std::vector<analysis::PlanGap> gaps;  ///< of shown fragments that face each other by 5 mm² or more

    const std::string& name(std::size_t n) const { return plan.fragments[n].name; }
    Pose pose(std::size_t n) const { return state.arrangement.pose(static_cast<int>(n)); }
    bool is_shown(std::size_t n) const { return !state.arrangement.is_hidden(static_cast<int>(n)); }
    /// Middle of a fragment's surface points in the frame of its scan, m.
    Vec3 middle(std::size_t n) const;
};

/// Loads and measures what a report draws. Throws Error.
DrawnPlan draw_plan(const plan::CasePlan& plan, const std::filesystem::path& folder);

/// sRGB of an artery or a vein.
const Vec3& colour_of(const reconstruction::FlapVessel& vessel);

/// A mesh at a pose, in one colour (sRGB).
display::PictureMesh placed(const mesh::Mesh& mesh, const Pose& pose, const Vec3& colour);

}  // namespace tactus::report

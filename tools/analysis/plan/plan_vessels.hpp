// SPDX-License-Identifier: Apache-2.0
// Adds and removes vessels of a plan by steps, and measures them against its fragments.
#pragma once

#include "assets/reconstruction/reconstruction.hpp"
#include "tools/analysis/plan/plan_case.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Loads a plan, applies `change` to its vessels and adds the result as a step. If the plan's state has a
/// reconstruction, these are its vessels, in the frame of the donor; otherwise those of the case, in the frame of the
/// scan. Throws Error if the result is invalid, and rethrows errors of `change`; then the plan is unchanged.
void change_vessels(const std::filesystem::path& plan,
                    const std::function<void(std::vector<reconstruction::FlapVessel>&)>& change);

/// Returns a vessel of the scan of a plan's case; if the current alternative has never had vessels, one of another
/// alternative. Vessels that were removed or undone there do not count. The vessel is part of `plan`. Throws Error if
/// there is none of that name.
const reconstruction::FlapVessel& vessel_of_scan(const plan::CasePlan& plan, const std::string& name);

double length_of(const reconstruction::FlapVessel& vessel);  ///< m

/// Returns the position `along` m from the first point of a vessel. Throws Error if it is not that long.
Vec3 place_along(const reconstruction::FlapVessel& vessel, double along);

/// Clearance between a vessel of the case and the shown fragments.
struct VesselClearance {
    const reconstruction::FlapVessel* vessel = nullptr;
    struct Nearest {
        int fragment = -1;  ///< -1: none is shown
        double gap = 0.0;  ///< m between its surface and the vessel's wall; negative: it reaches into the vessel
    };
    Nearest scanned, planned;
};
/// `fragments`: of the plan, in its order. Distances refer to surface points, so that their spacing limits the
/// precision.
std::vector<VesselClearance> vessel_clearances(const plan::PlanState& state,
                                               const std::vector<CaseFragment>& fragments);

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// Vessels of a plan: added and taken away by steps, and measured against its fragments.
#pragma once

#include "assets/reconstruct/reconstruction.hpp"
#include "tools/study/planning/plan_case.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::study {

/// Loads a plan, lets `change` alter its vessels and adds that as a step. Those of a reconstruction, when the plan's state
/// has one, in the frame of the donor; otherwise those of the case, in the frame of the scan. Throws Error when the result
/// cannot be, and what `change` throws; then the plan stays as it was.
void change_vessels(const std::filesystem::path& plan,
                    const std::function<void(std::vector<reconstruct::FlapVessel>&)>& change);

/// A vessel of the scan of a plan's case; where the current alternative has never had any, one of the others. What was
/// removed or undone there is none. The vessel is part of `plan`. Throws Error when there is none of that name.
const reconstruct::FlapVessel& vessel_of_scan(const cases::CasePlan& plan, const std::string& name);

double length_of(const reconstruct::FlapVessel& vessel);  ///< m

/// The place `along` m from the first point of a vessel. Throws Error when it is not that long.
Vec3 place_along(const reconstruct::FlapVessel& vessel, double along);

/// A vessel of the case against the fragments that are shown.
struct VesselClearance {
    const reconstruct::FlapVessel* vessel = nullptr;
    struct Nearest {
        int fragment = -1;  ///< -1: none is shown
        double gap = 0.0;  ///< m between its surface and the vessel's wall; negative: it reaches into the vessel
    };
    Nearest scanned, planned;
};
/// `fragments`: of the plan, in its order. Between surface points, which lie apart by their spacing.
std::vector<VesselClearance> vessel_clearances(const cases::PlanState& state,
                                               const std::vector<CaseFragment>& fragments);

}  // namespace tactus::study

// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_vessels.hpp"

#include "dsp/core/error.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace tactus::analysis {

using reconstruction::FlapVessel;

namespace {

/// The nearest fragment, with the poses that `pose` gives.
template <class PoseOf>
VesselClearance::Nearest nearest(const FlapVessel& vessel, const plan::PlanState& state,
                                 const std::vector<CaseFragment>& fragments, const PoseOf& pose) {
    VesselClearance::Nearest found;
    found.gap = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < fragments.size(); ++n) {
        if (state.arrangement.is_hidden(static_cast<int>(n))) continue;
        const Pose back = pose(static_cast<int>(n)).inverse();
        for (const Vec3& point : vessel.points) {
            const Vec3 at = back.apply(point);
            double least = std::numeric_limits<double>::infinity();
            for (const contact::SurfacePoint& p : fragments[n].bone.points) {
                const Vec3 away = p.position - at;
                least = std::min(least, glm::dot(away, away));
            }
            const double distance = std::sqrt(least), side = fragments[n].map.sample(at).value < 0.0 ? -1.0 : 1.0;
            if (const double gap = side * distance - vessel.radius; gap < found.gap) found = {static_cast<int>(n), gap};
        }
    }
    return found;
}

}  // namespace

const FlapVessel& vessel_of_scan(const plan::CasePlan& plan, const std::string& name) {
    std::vector<std::string> names;
    const auto look_in = [&](const plan::PlanState& state) -> const FlapVessel* {
        if (!state.vessels) return nullptr;
        for (const FlapVessel& one : *state.vessels) {
            if (one.name == name) return &one;
            if (std::ranges::find(names, one.name) == names.end()) names.push_back(one.name);
        }
        return nullptr;
    };
    const plan::PlanState now = plan::state_of(plan);
    if (const FlapVessel* found = look_in(now)) return *found;
    if (!now.vessels)
        for (auto other = plan.alternatives.rbegin(); other != plan.alternatives.rend(); ++other)
            if (const FlapVessel* found = look_in(plan::state_of(plan, other->place.head))) return *found;
    if (names.empty())
        throw Error(
            "the plan has no vessels of its scan; 'tactus plan vessel' adds them before there is a reconstruction");
    throw Error(fmt::format("the scan of the plan has no vessel '{}'; it has: {}", name, fmt::join(names, ", ")));
}

Vec3 place_along(const FlapVessel& vessel, double along) {
    double left = along;
    for (std::size_t n = 1; n < vessel.points.size(); ++n) {
        const Vec3 way = vessel.points[n] - vessel.points[n - 1];
        const double length = glm::length(way);
        if (left <= length) return length > 0.0 ? vessel.points[n - 1] + left / length * way : vessel.points[n];
        left -= length;
    }
    // Rounding of the sum may leave a little at the last point.
    if (!vessel.points.empty() && left < 1e-9) return vessel.points.back();
    throw Error(fmt::format("the vessel is {:.1f} mm long, less than {:.1f} mm", length_of(vessel) * 1e3, along * 1e3));
}

double length_of(const FlapVessel& vessel) {
    double length = 0.0;
    for (std::size_t n = 1; n < vessel.points.size(); ++n)
        length += glm::length(vessel.points[n] - vessel.points[n - 1]);
    return length;
}

void change_vessels(const std::filesystem::path& path, const std::function<void(std::vector<FlapVessel>&)>& change) {
    if (plan::state_of(plan::load_case_plan(path)).reconstruction)
        return change_reconstruction(
            path, [&](reconstruction::Reconstruction& all, const plan::CasePlan&) { change(all.flap.vessels); });
    OpenPlan open(path);
    const plan::PlanState state = plan::state_of(open.plan);
    auto changed = std::make_shared<std::vector<FlapVessel>>();
    if (state.vessels) *changed = *state.vessels;
    change(*changed);
    reconstruction::Flap flap;
    flap.vessels = *changed;
    reconstruction::check(flap, "the changed plan");
    plan::PlanStep step;
    step.kind = plan::StepKind::vessels;
    step.by = "command";
    step.vessels = std::move(changed);
    do_step(open.plan, std::move(step), path);
}

std::vector<VesselClearance> vessel_clearances(const plan::PlanState& state,
                                               const std::vector<CaseFragment>& fragments) {
    std::vector<VesselClearance> all;
    if (!state.vessels) return all;
    for (const FlapVessel& vessel : *state.vessels) {
        VesselClearance one;
        one.vessel = &vessel;
        one.scanned = nearest(vessel, state, fragments, [](int) { return Pose{}; });
        one.planned = nearest(vessel, state, fragments, [&](int n) { return state.arrangement.pose(n); });
        all.push_back(one);
    }
    return all;
}

}  // namespace tactus::analysis

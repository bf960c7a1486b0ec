// SPDX-License-Identifier: Apache-2.0
// Vessels that a plan has of its scan, and places on them.
#include "tools/analysis/plan/plan_vessels.hpp"

#include "assets/plan/case_plan.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("tools: a vessel of the scan that was removed or undone is no longer taken") {
    const auto vessel = [](double x) {
        reconstruction::FlapVessel one;
        one.name = "carotid";
        one.points = {{x, 0.0, 0.0}, {x + 0.1, 0.0, 0.0}};
        one.radius = 1e-3;
        return one;
    };
    const auto with = [](plan::CasePlan& plan, std::vector<reconstruction::FlapVessel> vessels) {
        plan::PlanStep step;
        step.kind = plan::StepKind::vessels;
        step.vessels = std::make_shared<std::vector<reconstruction::FlapVessel>>(std::move(vessels));
        plan::add_step(plan, std::move(step));
    };
    plan::CasePlan plan;
    CHECK_THROWS_WITH(analysis::vessel_of_scan(plan, "carotid"), ContainsSubstring("no vessels of its scan"));
    with(plan, {vessel(1.0)});
    with(plan, {vessel(2.0)});
    CHECK(analysis::vessel_of_scan(plan, "carotid").points[0].x == 2.0);
    plan.place().head = 0;
    CHECK(analysis::vessel_of_scan(plan, "carotid").points[0].x == 1.0);
    plan.place().head = 1;
    plan.alternatives.push_back({"other", {}});
    plan.current = 1;
    CHECK(analysis::vessel_of_scan(plan, "carotid").points[0].x == 2.0);
    plan.current = 0;
    with(plan, {});
    CHECK_THROWS_WITH(analysis::vessel_of_scan(plan, "carotid"), ContainsSubstring("no vessels of its scan"));
    plan.current = 1;
    CHECK_THROWS_WITH(analysis::vessel_of_scan(plan, "carotid"), ContainsSubstring("no vessels of its scan"));
}

TEST_CASE("the last point of a vessel lies on it, however its length rounds") {
    const Random random{3};
    std::uint64_t index = 0;
    const auto place = [&] { return 0.1 * random.uniform(index++); };
    int off = 0;
    for (int n = 0; n < 200; ++n) {
        reconstruction::FlapVessel vessel;
        for (int p = 0; p < 40; ++p) vessel.points.emplace_back(place(), place(), place());
        const Vec3 last = analysis::place_along(vessel, analysis::length_of(vessel));
        off += !(glm::length(last - vessel.points.back()) < 1e-12);
    }
    CHECK(off == 0);
}

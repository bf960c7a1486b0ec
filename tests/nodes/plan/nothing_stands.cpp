// SPDX-License-Identifier: Apache-2.0
// The matcher and the scene of a case in which nothing is locked, or a fit has become void.
#include "assets/library/fragments.hpp"
#include "assets/plan/plan_history.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/coupling/scene.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/notice.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <memory>
#include <string>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

/// The bundled fracture, coarse; `locked`: the left half is.
std::shared_ptr<plan::CaseBones> broken_or_locked(bool locked) {
    auto c = std::make_shared<plan::CaseBones>();
    c->bones = library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 0.8 * mm});
    for (const char* name : {"left", "right"}) c->plan.fragments.push_back({name, name, 0, Vec3(1.0)});
    if (!locked) return c;
    plan::PlanStep lock;
    lock.kind = plan::StepKind::lock;
    lock.fragments = {0};
    plan::add_step(c->plan, lock);
    return c;
}

coupling::Scene shown(const std::shared_ptr<const plan::CaseBones>& plan) {
    NodeHarness node("case_scene", {.period = flicks_per_second / 1000});
    node.asset("plan", plan);
    node.disconnect_optional();
    node.prepare();
    node.run(1);
    return node.last<coupling::Scene>("scene");
}

}  // namespace

TEST_CASE("a matcher that has nothing to fit to says so, with what to do") {
    for (const bool locked : {false, true}) {
        const std::shared_ptr<const plan::CaseBones> plan = broken_or_locked(locked);
        NodeHarness node("case_scene", {.period = flicks_per_second / 1000});
        node.asset("plan", plan);
        node.disconnect_optional();
        node.prepare();
        node.run(1);
        const auto now = node.last<coupling::Scene>("scene");
        NodeHarness matcher("fragment_matcher", {.period = flicks_per_second / 4});
        matcher.asset("plan", plan);
        matcher.feed("scene", now).feed<double>("held", 1.0).feed<bool>("engaged", true);
        matcher.prepare();
        matcher.run(1);
        // Said at once, and once.
        const std::vector<std::string> told_now = take_notices(matcher.host);
        REQUIRE(told_now.size() == (locked ? 0 : 1));
        if (!locked) CHECK(told_now[0].starts_with("node: nothing is locked or fitted"));
        matcher.run(2);
        CHECK(take_notices(matcher.host).empty());
        const Report report = matcher.report();
        const auto& told = report.sections.at("node");
        CHECK(std::get<double>(told.at("looks")) == 3.0);
        REQUIRE(told.contains("hint") == !locked);
        if (locked) continue;
        CHECK(std::get<double>(told.at("looks_without_partner")) == 3.0);
        CHECK(std::get<std::string>(told.at("hint")).find("lock a fragment") != std::string::npos);
    }
}

TEST_CASE("a fragment whose partner has moved away no longer stands") {
    const auto plan = broken_or_locked(false);
    REQUIRE(plan::change(plan->plan, plan::SettleFragment{1, 0, {}, {0.8, 0.5, 1e-4, 0.0, 0.0, 1e-4}}, {}) ==
            plan::PlanHistory::Outcome::done);
    CHECK(shown(plan).objects[1].stands);
    REQUIRE(plan::change(plan->plan, plan::PlaceFragment{0, {Vec3(0.0, 0.0, 1.0) * mm, {1.0, 0.0, 0.0, 0.0}}}, {}) ==
            plan::PlanHistory::Outcome::done);
    CHECK_FALSE(shown(plan).objects[1].stands);
    REQUIRE(plan::change(plan->plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
    CHECK(shown(plan).objects[1].stands);
}

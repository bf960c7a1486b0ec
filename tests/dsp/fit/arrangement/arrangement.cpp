// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/arrangement/arrangement.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/fit/arrangement/assemblies.hpp"
#include "dsp/fit/arrangement/history.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr int none = fit::Arrangement::none;

Pose turned(double x, double angle) { return {Vec3(x, 0.0, 0.0), rotation_by({0.0, 0.0, angle})}; }

int join(fit::Arrangement& a, std::initializer_list<int> fragments) {
    return a.join(std::span(fragments.begin(), fragments.size()));
}

}  // namespace

TEST_CASE("grouped fragments keep their places to each other when one is moved") {
    fit::Arrangement a(4);
    for (int n = 0; n < 4; ++n) a.place(n, turned(0.01 * n, 0.2 * n));
    REQUIRE(join(a, {0, 2}) != none);
    const Pose between = a.pose(0).inverse() * a.pose(2), alone = a.pose(1);
    REQUIRE(a.move(2, turned(-0.5, 1.0)));
    const Pose now = a.pose(0).inverse() * a.pose(2);
    CHECK(glm::length(now.position - between.position) < 1e-15);
    CHECK(glm::length(rotation_between(now.orientation, between.orientation)) < 1e-14);
    CHECK(a.pose(1).position == alone.position);
    CHECK(a.pose(2).position == Vec3(-0.5, 0.0, 0.0));
}

TEST_CASE("groups hold groups, and dissolving the outer one leaves the inner ones") {
    fit::Arrangement a(5);
    const int left = join(a, {0, 1}), right = join(a, {2, 3});
    const int both = join(a, {1, 3});
    CHECK(a.parent_of(left) == both);
    CHECK(a.parent_of(right) == both);
    CHECK(a.move_together(0, 2));
    CHECK_FALSE(a.move_together(0, 4));
    REQUIRE(a.add(both, 4));
    CHECK(a.move_together(2, 4));
    REQUIRE(a.dissolve(both));
    CHECK(a.move_together(0, 1));
    CHECK(a.move_together(2, 3));
    CHECK_FALSE(a.move_together(1, 2));
    CHECK(a.group_of(4) == none);
}

TEST_CASE("a fragment that is taken out stands alone, and no group of one is left") {
    fit::Arrangement a(3);
    const int pair = join(a, {0, 1});
    const int outer = join(a, {0, 2});
    REQUIRE(a.remove(1));
    CHECK_FALSE(a.exists(pair));
    CHECK(a.outermost(0) == outer);
    CHECK(a.move_together(0, 2));
    REQUIRE(a.remove(2));
    CHECK(a.outermost(0) == none);
    CHECK_FALSE(a.remove(0));
    for (int group = 0; group < static_cast<int>(a.max_groups()); ++group) CHECK_FALSE(a.exists(group));
}

TEST_CASE("what is together already is not joined again, and any number of joins finds room") {
    fit::Arrangement a(6);
    CHECK(join(a, {1}) == none);
    CHECK(join(a, {1, 1}) == none);
    for (int round = 0; round < 20; ++round) {
        for (int n = 1; n < 6; ++n) CHECK(join(a, {n - 1, n}) != none);
        CHECK(join(a, {0, 5}) == none);
        for (int n = 0; n < 6; ++n) a.remove(n);
    }
    CHECK_FALSE(a.add(2, 1));
}

TEST_CASE("a locked fragment holds its group, and no pose that is none moves anything") {
    fit::Arrangement a(3);
    join(a, {0, 1});
    a.lock(0, true);
    CHECK_FALSE(a.can_move(1));
    CHECK_FALSE(a.move(1, turned(1.0, 0.0)));
    CHECK(a.pose(1).position == Vec3(0.0));
    a.lock(0, false);
    CHECK_FALSE(a.move(1, turned(std::numeric_limits<double>::quiet_NaN(), 0.0)));
    CHECK(a.move(1, turned(1.0, 0.0)));
}

TEST_CASE("a fit holds while both fragments keep their places to each other, and no longer") {
    fit::Arrangement a(4);
    for (int n = 0; n < 4; ++n) a.place(n, turned(0.1 * n, 0.3 * n));
    a.fit(1, 0);
    a.fit(2, 1);
    CHECK(a.fitted_to(1) == 0);
    CHECK(fit::assemblies(a) == std::vector<std::vector<int>>{{0, 1, 2}, {3}});
    const Pose home = a.pose(0);
    REQUIRE(a.move(0, turned(0.04e-3, 0.0)));
    CHECK(a.fitted_to(1) == 0);
    REQUIRE(a.move(0, turned(0.0, 0.06 * std::numbers::pi / 180.0)));
    CHECK(a.fitted_to(1) == none);
    CHECK(a.was_fitted_to(1) == 0);
    CHECK(a.departure(1).angle == Approx(0.06 * std::numbers::pi / 180.0));
    CHECK(fit::assemblies(a) == std::vector<std::vector<int>>{{1, 2}, {0}, {3}});
    CHECK(fit::standing(a, 0) == std::vector<char>{0, 1, 1, 0});
    a.lock(3, true);
    CHECK(fit::standing(a, 0) == std::vector<char>{0, 0, 0, 1});
    REQUIRE(a.move(0, home));
    CHECK(a.fitted_to(1) == 0);
    // A fragment that moves takes its own connections with it.
    CHECK(fit::standing(a, 1) == std::vector<char>{0, 0, 0, 1});
    a.lock(3, false);
    CHECK(fit::standing(a, 1) == std::vector<char>{0, 0, 0, 0});
    join(a, {0, 1});
    for (int n = 1; n < 30; ++n) REQUIRE(a.move(n % 2, turned(0.5 * n, 0.7 * n)));
    CHECK(a.fitted_to(1) == 0);
    CHECK(a.fitted_to(2) == none);
    a.hide(0, true);
    CHECK(fit::assemblies(a).size() == 3);
}

TEST_CASE("steps are undone to the root and redone to the tip, and a new step leaves the old branch in the tree") {
    std::vector<int> before{-1, 0, 1};
    fit::HistoryPlace at = fit::after_step(2);
    for (const int head : {1, 0, -1, -1}) {
        at = fit::undone(before, at);
        CHECK(at.head == head);
    }
    for (const int head : {0, 1, 2, 2}) {
        at = fit::redone(before, at);
        CHECK(at.head == head);
    }
    at = fit::undone(before, fit::undone(before, at));
    before.push_back(at.head);
    at = fit::after_step(3);
    CHECK(fit::redone(before, at).head == 3);
    CHECK(fit::steps_to(before, at.head) == std::vector<int>{0, 3});
    CHECK(fit::is_on_way(before, 0, 3));
    CHECK_FALSE(fit::is_on_way(before, 2, 3));
    CHECK(fit::steps_to(before, 2) == std::vector<int>{0, 1, 2});
}

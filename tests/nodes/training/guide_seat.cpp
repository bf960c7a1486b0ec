// SPDX-License-Identifier: Apache-2.0
// A cutting guide in the hand: drawn to its seat, and then left there.
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "graph/node/task_asset.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <functional>
#include <memory>

using namespace tactus;
using test::NodeHarness;

namespace {

std::shared_ptr<const training::Task> with_guide() {
    auto task = std::make_shared<training::Task>();
    auto ball = std::make_shared<bone::Bone>();
    volume::Grid& grid = ball->distance;
    grid = {{30, 30, 30}, Vec3(-15.0 * mm), Vec3(1.0 * mm), {}};
    grid.values.resize(grid.count());
    for (int k = 0; k < 30; ++k)
        for (int j = 0; j < 30; ++j)
            for (int i = 0; i < 30; ++i)
                grid.at(i, j, k) = static_cast<float>(glm::length(grid.position(i, j, k)) - 8.0 * mm);
    ball->density = grid;
    task->guide = training::GuideFile{"ball.vdb", {0.0, 0.0, 1.0}, 1};
    task->guide_body = std::move(ball);
    return task;
}

}  // namespace

TEST_CASE("a guide that is held at its seat is seated, and the force on the hand fades") {
    NodeHarness node("guide_seat", test::servo);
    node.asset("task", with_guide());
    Pose moved;
    double place = -1.0;
    node.feed<Pose>("hand", Pose{Vec3(0.0, 0.0, 0.1), {1.0, 0.0, 0.0, 0.0}});
    node.feed<Pose>("moved", std::function<Pose(std::int64_t)>([&](std::int64_t) { return moved; }));
    node.feed<double>("place", std::function<double(std::int64_t)>([&](std::int64_t) { return place; }));
    node.prepare();
    node.run(1);
    // It begins 20 mm above the seat, in the hand.
    const Pose seat = node.last<Pose>("target");
    CHECK(node.last<double>("distance") == Approx(20.0 * mm));
    place = 1.0;
    moved = {seat.position + Vec3(0.0, 0.0, 20.0 * mm), seat.orientation};
    node.run(50);
    CHECK(node.last<bool>("holding"));
    CHECK(node.last<double>("held") == 1.0);
    CHECK_FALSE(node.last<bool>("near"));
    CHECK(node.last<double>("distance") == Approx(20.0 * mm));
    const Pose held = Pose{Vec3(0.0, 0.0, 0.1), {1.0, 0.0, 0.0, 0.0}} * node.last<Pose>("grip");
    CHECK(glm::length(held.position - moved.position) < 1e-9);
    moved.position = seat.position + Vec3(0.0, 0.0, 3.0 * mm);
    node.run(500);
    CHECK(node.last<bool>("near"));
    CHECK_FALSE(node.last<bool>("seated"));
    // Near enough, but turned by 2 degrees.
    moved = {seat.position + Vec3(0.0, 0.0, 0.3 * mm), rotation_by(Vec3(2.0 * degree, 0.0, 0.0))};
    node.run(500);
    CHECK_FALSE(node.last<bool>("seated"));
    moved.orientation = rotation_by(Vec3(0.5 * degree, 0.0, 0.0));
    node.run(290);
    CHECK_FALSE(node.last<bool>("seated"));
    CHECK(node.last<double>("strength") == 1.0);
    node.run(30);
    CHECK(node.last<bool>("seated"));
    CHECK_FALSE(node.last<bool>("holding"));
    CHECK(node.last<double>("strength") > 0.5);
    // What is left of the way to the seat stays, and moves the slots.
    const Pose error = moved * seat.inverse();
    CHECK(glm::length(node.last<Pose>("pose").position - moved.position) < 1e-12);
    CHECK(glm::length(node.last<Pose>("offset").position - error.position) < 1e-12);
    CHECK(glm::length(node.last<Pose>("offset").position) > 0.29 * mm);
    CHECK(glm::length(rotation_between(error.orientation, node.last<Pose>("offset").orientation)) < 1e-12);
    CHECK(node.last<double>("distance") == Approx(0.3 * mm));
    CHECK(node.last<double>("angle") == Approx(0.5 * degree));
    node.run(100);
    CHECK(node.last<double>("strength") == 0.0);
    CHECK(node.last<double>("held") == -1.0);
    // It stays, wherever the hand goes.
    moved.position += Vec3(0.05);
    node.run(10);
    CHECK(node.last<bool>("seated"));
    CHECK(glm::length(node.last<Pose>("offset").position - error.position) < 1e-12);
}

TEST_CASE("the grip of a guide is that of the hand when the scene has come through, not of its first sample") {
    NodeHarness node("guide_seat", test::servo);
    node.asset("task", with_guide());
    // What a wire between groups brings before any value.
    Pose hand;
    double place = -1.0;
    Pose moved;
    node.feed<Pose>("hand", std::function<Pose(std::int64_t)>([&](std::int64_t) { return hand; }));
    node.feed<Pose>("moved", std::function<Pose(std::int64_t)>([&](std::int64_t) { return moved; }));
    node.feed<double>("place", std::function<double(std::int64_t)>([&](std::int64_t) { return place; }));
    node.prepare();
    node.run(2);
    CHECK_FALSE(node.last<bool>("holding"));
    hand = {Vec3(0.01, 0.02, 0.1), rotation_by(Vec3(0.3, 0.0, 0.0))};
    const Pose there = node.last<Pose>("pose");
    place = 1.0;
    // A coupling that holds nothing yet has no pose of the guide: that of its output at the start.
    node.run(1);
    CHECK(node.last<bool>("holding"));
    moved = there;
    node.run(1);
    const Pose held = hand * node.last<Pose>("grip");
    CHECK(glm::length(held.position - there.position) < 1e-12);
    CHECK(node.last<double>("distance") == Approx(20.0 * mm));
}

TEST_CASE("a guide that nobody holds is not seated, even where it begins at its seat") {
    NodeHarness node("guide_seat", test::servo);
    node.asset("task", with_guide());
    node.set("lift", "0 mm");
    node.feed<Pose>("hand", Pose{}).feed<Pose>("moved", Pose{}).feed("place", -1.0);
    node.prepare();
    node.run(1000);
    CHECK(node.last<double>("distance") < 1e-9);
    CHECK_FALSE(node.last<bool>("seated"));
}

TEST_CASE("without a guide the hand has the saw at once") {
    NodeHarness node("guide_seat", test::servo);
    node.asset("task", std::make_shared<const training::Task>());
    node.prepare();
    node.run(1);
    CHECK(node.last<bool>("seated"));
    CHECK_FALSE(node.last<bool>("holding"));
    CHECK(node.last<double>("strength") == 0.0);
}

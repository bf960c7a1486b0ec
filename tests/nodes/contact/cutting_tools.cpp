// SPDX-License-Identifier: Apache-2.0
// What saw_blade and burr report beside their forces.
#include "dsp/core/rotation.hpp"
#include "dsp/volume/bricks.hpp"
#include "graph/node/task_asset.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

/// Down by 6 mm in 0.6 s, for 0.4 s there, out again, and at rest.
Pose press(std::int64_t k) {
    const double ms = static_cast<double>(k);
    const double deep = std::clamp(ms / 600.0, 0.0, 1.0) - std::clamp((ms - 1000.0) / 600.0, 0.0, 1.0);
    return {Vec3(0.0, 0.0, 5e-3 - 6e-3 * deep), teeth_down};
}

}  // namespace

TEST_CASE("contact of a saw and a burr ends when they are out of the bone") {
    for (const char* type : {"saw_blade", "burr"}) {
        const auto bone = bone_block({.voxel = 0.5e-3});
        NodeHarness node(type, servo);
        node.disconnect_optional();
        node.feed<Pose>("pose", press).feed("bone", bone->current());
        node.prepare();
        node.run(2500);
        const auto touches = node.values<bool>("in_contact");
        const auto force = node.values<Wrench>("wrench");
        const auto last = static_cast<std::size_t>(std::ranges::find(touches.rbegin(), touches.rend(), true).base() -
                                                   touches.begin());
        CAPTURE(type, last);
        CHECK(last > 1000);
        CHECK(last < 1700);
        for (std::size_t k = 1700; k < force.size(); ++k) REQUIRE(force[k].force == Vec3(0.0));
        CHECK_FALSE(touches.front());
    }
}

TEST_CASE("a tool cuts by the share of its force that the device was given") {
    for (const char* type : {"saw_blade", "burr"})
        for (const auto& [given, share] : {std::pair{4.0, 1.0}, std::pair{3.0, 0.75}, std::pair{0.0, 0.0},
                                           std::pair{-1.0, 0.0}, std::pair{9.0, 1.0}}) {
            const auto bone = bone_block({.voxel = 0.5e-3});
            NodeHarness node(type, servo);
            node.disconnect_optional();
            node.feed<Pose>("pose", press).feed("bone", bone->current());
            node.connect("asked").connect("applied");
            node.feed("asked", Wrench{{0.0, 0.0, 4.0}, {}}).feed("applied", Wrench{{0.0, 0.0, given}, {}});
            node.prepare();
            node.run(1000);
            const auto feed = node.values<double>("feed");
            CAPTURE(type, given);
            CHECK(node.last<double>("rendered") == Approx(share));
            CHECK((*std::ranges::max_element(feed) > 0.0) == (share > 0.0));
        }
}

TEST_CASE("a guide that is not quite on its seat has its slots and its walls where it is") {
    auto task = std::make_shared<training::Task>();
    // Walls of 8 mm over a slot of 1.5 mm: n = y, from z = 0 to 15 mm.
    const BoneBox box{.low = {-12e-3, -8e-3, 0.0}, .high = {12e-3, 8e-3, 15e-3}, .voxel = 0.4e-3};
    const auto solid = bone_where(box, [&](const Vec3& p) {
        const Vec3 q = glm::max(box.low - p, p - box.high);
        const double wall = glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
        return std::max(wall, 0.75e-3 - std::abs(p.y));
    });
    auto body = std::make_shared<bone::Bone>();
    body->distance = volume::to_grid(solid->current());
    body->density = body->distance;
    task->guide = training::GuideFile{"guide.vdb", {0.0, 0.0, 1.0}, 1};
    task->guide_body = std::move(body);
    saw::GuideSlot slot;
    slot.frame = {Vec3(0.0), teeth_down};
    slot.low = -12e-3, slot.high = 12e-3, slot.top = -15e-3, slot.bottom = 0.0, slot.wall = -0.75e-3;
    slot.other_wall = 0.75e-3;
    task->slots = {slot};
    const auto bone = bone_block({.low = {0.5, 0.0, 0.0}, .high = {0.51, 0.01, 0.01}});
    const Pose offset{Vec3(1.5e-3, 1.0e-3, -0.4e-3), rotation_by(Vec3(0.02, -0.01, 0.03))};
    const auto run = [&](const Pose& at, const std::function<Pose(std::int64_t)>& hand, auto&& judge) {
        NodeHarness node("saw_blade", servo);
        node.disconnect_optional();
        node.asset("guide", std::shared_ptr<const training::Task>(task));
        node.set("length", "10 mm").set("height", "40 mm");
        node.feed<Pose>("pose", [&](std::int64_t k) { return at * hand(k); }).feed("bone", bone->current());
        // Later changes of the offset move no wall.
        node.connect("guide_offset").feed<Pose>("guide_offset", [&](std::int64_t k) {
            return k < 10 ? at : Pose{at.position + Vec3(0.0, 2e-3, 0.0), at.orientation};
        });
        node.connect("seated").feed("seated", true);
        node.prepare();
        node.run(400);
        judge(node);
    };
    // Into the slot and against a wall of it; and beside the slot, down on the guide.
    const auto into = [](std::int64_t k) {
        const double t = std::min(1.0, static_cast<double>(k) / 200.0);
        return Pose{Vec3(0.0, 1.2e-3 * std::max(0.0, static_cast<double>(k) - 200.0) / 200.0, 18e-3 - 10e-3 * t),
                    teeth_down};
    };
    const auto onto = [](std::int64_t k) {
        return Pose{Vec3(0.0, 4e-3, 17e-3 - 3e-3 * static_cast<double>(k) / 400.0), teeth_down};
    };
    for (const auto& hand : {std::function<Pose(std::int64_t)>(into), std::function<Pose(std::int64_t)>(onto)}) {
        Pose held;
        Wrench wrench;
        double in_slot = -1.0;
        run({}, hand, [&](NodeHarness& node) {
            held = node.last<Pose>("held");
            wrench = node.last<Wrench>("wrench");
            in_slot = node.last<double>("slot");
        });
        CHECK(glm::length(wrench.force) > 0.5);
        run(offset, hand, [&](NodeHarness& node) {
            CHECK(node.last<double>("slot") == in_slot);
            CHECK(glm::length((offset * held).position - node.last<Pose>("held").position) < 1e-6);
            CHECK(glm::length(offset.rotate(wrench.force) - node.last<Wrench>("wrench").force) <
                  1e-3 * glm::length(wrench.force));
            CHECK(glm::length(offset.rotate(wrench.torque) - node.last<Wrench>("wrench").torque) < 1e-5);
        });
    }
}

TEST_CASE("the forces on a device are scaled, and the forces that cut are not") {
    for (const char* type : {"saw_blade", "burr"}) {
        std::vector<double> force, load;
        for (const char* scale : {"1", "0.25"}) {
            const auto bone = bone_block({.voxel = 0.5e-3});
            NodeHarness node(type, servo);
            node.disconnect_optional();
            node.feed<Pose>("pose", press).feed("bone", bone->current());
            node.set("device_scale", scale);
            node.prepare();
            node.run(900);
            force.push_back(node.last<Wrench>("wrench").force.z);
            load.push_back(node.last<double>("load"));
        }
        CHECK(load[1] == load[0]);
        CHECK(force[1] == Approx(0.25 * force[0]));
    }
}

TEST_CASE("a saw that would feel stiffer than 40 N per mm is refused, and a scale that is set later is cut off there") {
    const auto bone = bone_block({.voxel = 0.5e-3});
    const auto saw = [&](const char* scale) {
        auto node = std::make_unique<NodeHarness>("saw_blade", servo);
        node->disconnect_optional();
        node->feed<Pose>("pose", press).feed("bone", bone->current());
        node->set("stiffness", "20 N/mm").set("device_scale", scale);
        return node;
    };
    CHECK_THROWS_WITH(saw("2.1")->prepare(), Catch::Matchers::ContainsSubstring("above 40 N/mm"));
    const auto allowed = saw("2"), later = saw("1");
    allowed->prepare();
    later->prepare();
    later->set("device_scale", "10");
    allowed->run(600);
    later->run(600);
    CHECK(later->last<Wrench>("wrench").force.z == Approx(allowed->last<Wrench>("wrench").force.z));
    CHECK(later->last<Wrench>("wrench").force.z > 1.0);
}

TEST_CASE("a tool that begins in bone says that it waits") {
    for (const char* type : {"saw_blade", "burr"}) {
        const auto bone = bone_block({.voxel = 0.5e-3});
        NodeHarness node(type, servo);
        node.disconnect_optional();
        node.feed<Pose>("pose", [](std::int64_t k) {
            return Pose{Vec3(0.0, 0.0, -3e-3 + 0.02e-3 * static_cast<double>(k)), teeth_down};
        });
        node.feed("bone", bone->current());
        node.prepare();
        node.run(800);
        const auto waits = node.values<bool>("waiting");
        CHECK(waits.front());
        CHECK(waits[100]);
        CHECK_FALSE(waits.back());
    }
}

TEST_CASE("the input 'release' frees a tool over 100 ms") {
    for (const char* type : {"saw_blade", "burr"}) {
        const auto bone = bone_block({.voxel = 0.5e-3});
        NodeHarness node(type, servo);
        node.disconnect_optional();
        node.connect("running").connect("release");
        node.feed<Pose>("pose", press).feed("bone", bone->current()).feed("running", false);
        node.feed<bool>("release", [](std::int64_t k) { return k >= 700 && k < 705; });
        node.prepare();
        node.run(950);
        const auto force = node.values<Wrench>("wrench");
        CAPTURE(type, force[699].force.z, force[750].force.z);
        CHECK(force[699].force.z > 0.1);
        CHECK(force[750].force.z == Approx(0.5 * force[699].force.z).epsilon(0.05));
        CHECK(force[801].force == Vec3(0.0));
        CHECK(force.back().force == Vec3(0.0));
    }
}

TEST_CASE("a tool in a slow group counts and cuts for the whole of each period") {
    for (const char* type : {"saw_blade", "burr"}) {
        const auto seconds_at = [type](int rate) {
            const auto bone = bone_block({.voxel = 0.5e-3});
            NodeHarness node(type, {.period = flicks_per_second / rate});
            node.disconnect_optional();
            node.feed<Pose>("pose", [rate](std::int64_t k) { return press(k * 1000 / rate); });
            node.feed("bone", bone->current());
            node.prepare();
            node.run(3 * rate);
            return *node.report().number("contact", "seconds");
        };
        const double slow = seconds_at(10), quick = seconds_at(20);
        CAPTURE(type, slow, quick);
        CHECK(quick > 0.5);
        CHECK(slow == Approx(quick).margin(0.25));
    }
}

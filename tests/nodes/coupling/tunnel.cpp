// SPDX-License-Identifier: Apache-2.0
// Thin walls against fast and long things in the hand: nothing may end up behind a wall.
#include "dsp/contact/shape.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using test::NodeHarness;

namespace {

struct Part {
    contact::Pointshell shell;
    contact::Voxmap map;

    template <class Shape>
    Part(const Shape& shape, double spacing, double voxel)
        : shell(contact::make_pointshell(shape.points(spacing))), map(contact::voxmap_of(shape, voxel, 3.0 * mm)) {}
    coupling::Body body(std::uint64_t hash) const { return {&shell, &map, nullptr, {}, 1, hash}; }
};

const Part& wall() {
    static const Part part(contact::Box{Vec3(40.0, 40.0, 1.0) * mm}, 1.0 * mm, 0.25 * mm);
    return part;
}
const Part& cube() {
    static const Part part(contact::Box{Vec3(5.0 * mm)}, 1.0 * mm, 0.25 * mm);
    return part;
}
const Part& tip() {
    static const Part part(contact::Ball{0.25 * mm}, 0.3 * mm, 0.1 * mm);
    return part;
}

/// Place 0: a wall of 1 mm at x = 80 mm, its upper face at z = 0. Places 1 and 2 are one unit: a cube at the origin and
/// a cube 80 mm beside it that floats 1 mm above the wall.
coupling::Scene unit_and_wall() {
    coupling::Scene scene;
    scene.count = 3;
    scene.objects[0] = {wall().body(1), {{80.0 * mm, 0.0, -0.5 * mm}, {1, 0, 0, 0}}};
    scene.objects[1] = {cube().body(2), {{0.0, 0.0, 3.5 * mm}, {1, 0, 0, 0}}, 4};
    scene.objects[2] = {cube().body(2), {{80.0 * mm, 0.0, 3.5 * mm}, {1, 0, 0, 0}}, 4};
    scene.content_hash = coupling::hash_of(scene);
    return scene;
}

/// Place 0: the wall, its upper face at z = 0. Place 1: a tip.
coupling::Scene tip_and_wall() {
    coupling::Scene scene;
    scene.count = 2;
    scene.objects[0] = {wall().body(1), {{0.0, 0.0, -0.5 * mm}, {1, 0, 0, 0}}};
    scene.objects[1] = {tip().body(3), {{0.0, 0.0, 5.0 * mm}, {1, 0, 0, 0}}};
    scene.content_hash = coupling::hash_of(scene);
    return scene;
}

constexpr const char* couplings[] = {"quasi_static_coupling", "dynamic_coupling"};

}  // namespace

TEST_CASE("a cube that is held 80 mm from its partner stays above a wall of 1 mm when the hand turns by 5 degrees") {
    for (const char* type : couplings)
        for (const double ticks : {1.0, 5.0, 20.0, 100.0}) {
            NodeHarness node(type, test::servo);
            node.set("held", "1").set("angular_stiffness", "20 N m/rad").set("max_torque", "5 N m");
            node.feed("scene", unit_and_wall());
            node.feed<Pose>("device", [ticks](std::int64_t k) {
                const double turn = 5.0 * degree * std::clamp(static_cast<double>(k - 5) / ticks, 0.0, 1.0);
                return Pose{{0.0, 0.0, 3.5 * mm}, rotation_by({0.0, turn, 0.0})};
            });
            node.disconnect_optional();
            node.prepare();
            node.run(400);
            const Pose partner = node.last<Pose>("pose") * Pose{{80.0 * mm, 0.0, 0.0}, {1, 0, 0, 0}};
            CAPTURE(type, ticks);
            CHECK(partner.position.z > 2.0 * mm);
            CHECK(std::abs(node.last<Wrench>("wrench").torque.y) > 0.1);
        }
}

TEST_CASE("a small tip that is pushed at up to 2 m/s stays above a wall of 1 mm") {
    for (const char* type : couplings)
        for (const char* stiffness : {"1 N/mm", "20 N/mm"})
            for (const char* points : {"0 N/mm", "10 N/mm", "100 N/mm"})
                for (const double speed : {0.05, 0.3, 1.0, 2.0})
                    for (const double phase : {0.0, 0.3, 0.6, 0.9}) {
                        NodeHarness node(type, test::servo);
                        node.set("held", "1").set("stiffness", stiffness).set("point_stiffness", points);
                        node.feed("scene", tip_and_wall());
                        node.feed<Pose>("device", [=](std::int64_t k) {
                            const double way = speed * 1e-3 * (static_cast<double>(k) + phase);
                            return Pose{{0.3 * mm, 0.1 * mm, std::max(5.0 * mm - way, -20.0 * mm)}, {1, 0, 0, 0}};
                        });
                        node.disconnect_optional();
                        node.prepare();
                        node.run(800);
                        CAPTURE(type, stiffness, points, speed, phase);
                        CHECK(node.last<Pose>("pose").position.z >
                              -0.6 * mm);  // about the middle; the far face is at -1 mm
                        CHECK(node.last<Wrench>("wrench").force.z == Approx(10.0).epsilon(0.02));
                    }
}

TEST_CASE("a tip that was pushed against the middle of a wall slides on and comes off when the hand goes back") {
    for (const char* type : couplings) {
        NodeHarness node(type, test::servo);
        node.set("held", "1").set("stiffness", "20 N/mm");
        node.feed("scene", tip_and_wall());
        node.feed<Pose>("device", [](std::int64_t k) {
            const double t = static_cast<double>(k) * 1e-3;
            const double z = t < 0.5 ? 5.0 * mm - 20.0 * mm * t : -5.0 * mm + 20.0 * mm * std::min(t - 0.5, 0.5);
            return Pose{{0.0, 0.0, z}, {1, 0, 0, 0}};
        });
        node.disconnect_optional();
        node.prepare();
        node.run(1500);
        CAPTURE(type);
        CHECK(node.last<Pose>("pose").position.z == Approx(5.0 * mm).margin(0.05 * mm));
        CHECK(glm::length(node.last<Wrench>("wrench").force) < 0.05);
    }
}

// SPDX-License-Identifier: Apache-2.0
// What must not throw a planning session off: bone that is carved while a fragment snaps to it, plates so thin that a
// field hardly knows their inside, and a fragment that is taken where it lies deep in another.
#include "assets/library/fragments.hpp"
#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/shape.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

/// From one tick to the next, from `first` on.
double largest_step(const std::vector<Wrench>& felt, std::size_t first) {
    double most = 0.0;
    for (std::size_t k = first; k < felt.size(); ++k)
        most = std::max(most, glm::length(felt[k].force - felt[k - 1].force));
    return most;
}

}  // namespace

TEST_CASE("bone that is carved away at the break while a fragment snaps to it changes the force without a jump") {
    const std::vector<bone::Bone> bones =
        library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 0.8 * mm});
    const contact::Pointshell shells[] = {contact::make_pointshell(bones[0].points),
                                          contact::make_pointshell(bones[1].points)};
    const contact::Voxmap right = contact::make_voxmap(bones[1].distance);
    // Sixty versions a second of the left half, a ball that grows at the rim of the break.
    std::vector<contact::Voxmap> carved;
    for (int n = 0; n <= 30; ++n) {
        volume::Grid field = bones[0].distance;
        const double radius = 0.15 * mm * n;
        std::size_t at = 0;
        for (int k = 0; k < field.size[2]; ++k)
            for (int j = 0; j < field.size[1]; ++j)
                for (int i = 0; i < field.size[0]; ++i, ++at) {
                    const double inside = radius - glm::length(field.position(i, j, k) - Vec3(0.0, 6.0, 0.0) * mm);
                    field.values[at] = std::max(field.values[at], static_cast<float>(n > 0 ? inside : -1.0));
                }
        carved.push_back(contact::make_voxmap(std::move(field)));
    }
    const auto scene_at = [&](std::int64_t tick) {
        const auto version = std::clamp<std::int64_t>((tick - 300) / 17, 0, 30);
        coupling::Scene scene;
        scene.count = 2;
        scene.objects[0] = {{&shells[0],
                             &carved[static_cast<std::size_t>(version)],
                             nullptr,
                             {},
                             version + 1,
                             static_cast<std::uint64_t>(version) + 10},
                            {}};
        scene.objects[1] = {{&shells[1], &right, nullptr, {}, 1, 2}, {}};
        scene.version = version + 1;
        scene.content_hash = coupling::hash_of(scene);
        return scene;
    };
    NodeHarness node("snap_to_fit", test::servo);
    node.asset("moving", std::make_shared<const bone::Bone>(bones[1]))
        .asset("fixed", std::make_shared<const bone::Bone>(bones[0]));
    node.set("held", "1").set("target", "0");
    node.feed<coupling::Scene>("scene", scene_at);
    const Pose grip{Vec3(-20.0 * mm, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}};
    const Pose beside = Pose{Vec3(1.2, 0.6, -0.7) * mm, rotation_by({0.05, 0.03, -0.04})} * grip.inverse();
    node.feed<Pose>("device", beside).feed("grip", grip);
    node.feed<bool>("engaged", [](std::int64_t k) { return k >= 100; });
    node.feed<bool>("settle", [](std::int64_t k) { return k >= 1100; });
    node.disconnect("holding").disconnect("strength");
    node.prepare();
    node.run(1600);
    CHECK(node.finite());
    // It has snapped before the carving begins.
    CHECK(largest_step(node.values<Wrench>("wrench"), 250) < 0.1);
    // What is left of the break still holds it in its place.
    const Pose rest = node.last<Pose>("pose");
    double off = 0.0;
    for (const Vec3& corner : {Vec3(0.0, 0.0, 12.0), Vec3(30.0, 0.0, 0.0), Vec3(0.0, 6.0, -12.0)})
        off = std::max(off, glm::length(rest.apply(corner * mm) - corner * mm));
    CHECK(off < 0.3 * mm);
}

TEST_CASE("a target behind a thin plate pulls nothing through it, neither does a hand, and both let go again") {
    const auto part = [](const contact::Box& box, double spacing) {
        volume::Grid grid{{0, 0, 0}, box.low() - Vec3(3.0 * mm), Vec3(0.5 * mm), {}};
        for (int axis = 0; axis < 3; ++axis)
            grid.size[static_cast<std::size_t>(axis)] =
                static_cast<int>(std::ceil((box.size[axis] + 6.0 * mm) / (0.5 * mm))) + 1;
        return std::pair(contact::make_pointshell(box.points(spacing)),
                         contact::sample_voxmap(grid, [&](const Vec3& p) { return box.distance(p); }));
    };
    // Two voxels of bone.
    const auto plate = part({Vec3(40.0, 40.0, 1.0) * mm}, 2.0 * mm), box = part({Vec3(10.0 * mm)}, 1.0 * mm);
    coupling::Scene scene;
    scene.count = 2;
    scene.objects[0] = {{&plate.first, &plate.second, nullptr, {}, 1, 1}, {{0.0, 0.0, 0.0}, {1, 0, 0, 0}}};
    scene.objects[1] = {{&box.first, &box.second, nullptr, {}, 1, 2}, {{0.0, 0.0, 10.0 * mm}, {1, 0, 0, 0}}};
    scene.version = 1;
    scene.content_hash = coupling::hash_of(scene);
    NodeHarness node("quasi_static_coupling", test::servo);
    node.set("held", "1");
    for (const char* open : {"grip", "holding", "strength", "has_target", "target_of"}) node.disconnect(open);
    node.feed("scene", scene);
    // Down to the far side in 40 ms, and back.
    node.feed<Pose>("device", [](std::int64_t k) {
        const double down = std::clamp(static_cast<double>(k - 300) * 0.5, 0.0, 20.0),
                     up = std::clamp(static_cast<double>(k - 1000) * 0.5, 0.0, 20.0);
        return Pose{{0.0, 0.0, (10.0 - down + up) * mm}, {1, 0, 0, 0}};
    });
    node.feed<Pose>("target", Pose{{0.0, 0.0, -10.0 * mm}, {1, 0, 0, 0}});
    node.feed<bool>("guided", [](std::int64_t k) { return k >= 100 && k < 1000; });
    node.feed<bool>("settle", false);
    node.prepare();
    node.run(1500);
    CHECK(node.finite());
    for (const Pose& pose : node.values<Pose>("pose")) REQUIRE(pose.position.z > 5.5 * mm - 0.2 * mm);
    CHECK(node.last<Pose>("pose").position.z == Approx(10.0 * mm).margin(0.05 * mm));
}

TEST_CASE("a fragment that is taken deep inside of another and led comes out without harm, and to its place") {
    const std::vector<bone::Bone> bones =
        library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 0.8 * mm});
    const contact::Pointshell shells[] = {contact::make_pointshell(bones[0].points),
                                          contact::make_pointshell(bones[1].points)};
    const contact::Voxmap maps[] = {contact::make_voxmap(bones[0].distance), contact::make_voxmap(bones[1].distance)};
    coupling::Scene scene;
    scene.count = 2;
    for (std::size_t n = 0; n < 2; ++n) scene.objects[n] = {{&shells[n], &maps[n], nullptr, {}, 1, n + 1}, {}};
    scene.version = 1;
    scene.content_hash = coupling::hash_of(scene);
    const Pose grip{Vec3(-20.0 * mm, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}};
    for (const double depth : {3.0 * mm, 5.0 * mm}) {
        CAPTURE(depth);
        NodeHarness node("quasi_static_coupling", test::servo);
        node.set("held", "1");
        for (const char* open : {"holding", "strength", "has_target", "target_of"}) node.disconnect(open);
        node.feed("scene", scene).feed("grip", grip);
        node.feed<Pose>("device", Pose{Vec3(-depth, 0.5 * mm, 0.0), {1.0, 0.0, 0.0, 0.0}} * grip.inverse());
        node.feed<Pose>("target", Pose{});
        node.feed<bool>("guided", true);
        node.feed<bool>("settle", [](std::int64_t k) { return k >= 600; });
        node.prepare();
        node.run(1200);
        CHECK(node.finite());
        const auto felt = node.values<Wrench>("wrench");
        double most = 0.0;
        for (const Wrench& w : felt) most = std::max(most, glm::length(w.force));
        CHECK(most < 10.01);
        CHECK(largest_step(felt, 1) < 0.3);
        CHECK(glm::length(node.last<Pose>("pose").position) < 0.3 * mm);
    }
}

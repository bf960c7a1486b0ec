// SPDX-License-Identifier: Apache-2.0
#include "assets/library/fragments.hpp"
#include "dsp/contact/pointshell.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/simulate/hand.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

using namespace tactus;
using test::NodeHarness;

namespace {

/// The bundled fracture, coarse: where both halves stand fitted, as bodies and as bones.
struct Fracture {
    std::shared_ptr<const bone::Bone> left, right;
    contact::Pointshell shells[2];
    contact::Voxmap maps[2];
    coupling::Scene scene;

    Fracture() {
        std::vector<bone::Bone> bones =
            library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 0.8 * mm});
        left = std::make_shared<const bone::Bone>(std::move(bones[0]));
        right = std::make_shared<const bone::Bone>(std::move(bones[1]));
        scene.count = 2;
        for (std::size_t n = 0; n < 2; ++n) {
            const bone::Bone& bone = n == 0 ? *left : *right;
            shells[n] = contact::make_pointshell(bone.points);
            maps[n] = contact::make_voxmap(bone.distance);
            scene.objects[n] = {{&shells[n], &maps[n], nullptr, {}, 1, n + 1}, {}};
        }
        scene.version = 1;
        scene.content_hash = coupling::hash_of(scene);
    }
};

const Fracture& fracture() {
    static const Fracture made;
    return made;
}

/// Held two centimetres from its break.
const Pose grip{Vec3(-20.0 * mm, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}};

double off(const Pose& pose) {
    const Vec3 corners[] = {{0.0, 0.0, 12.0 * mm}, {30.0 * mm, 0.0, 0.0}, {0.0, 6.0 * mm, -12.0 * mm}};
    double most = 0.0;
    for (const Vec3& c : corners) most = std::max(most, glm::length(pose.apply(c) - c));
    return most;
}

struct Session {
    NodeHarness node{"snap_to_fit", test::servo};

    template <class Hand>
    Session(const Hand& hand, std::int64_t ticks, std::int64_t engage, std::int64_t settle) {
        node.asset("moving", fracture().right).asset("fixed", fracture().left);
        node.set("held", "1").set("target", "0");
        node.feed("scene", fracture().scene);
        node.feed<Pose>("device", hand);
        node.feed("grip", grip);
        node.feed<bool>("engaged", [engage](std::int64_t k) { return k >= engage; });
        node.feed<bool>("settle", [settle](std::int64_t k) { return k >= settle; });
        node.disconnect("holding").disconnect("strength");
        node.prepare();
        node.run(ticks);
    }
};

/// 1.5 mm and 4 degrees away from the fit, the hand still.
const Pose beside = Pose{Vec3(1.2, 0.6, -0.7) * mm, rotation_by({0.05, 0.03, -0.04})} * grip.inverse();

}  // namespace

TEST_CASE("a fragment held beside its place is drawn there, and settles where the hand does not bias it") {
    Session session([](std::int64_t) { return beside; }, 1600, 100, 900);
    const auto poses = session.node.values<Pose>("pose");
    const auto felt = session.node.values<Wrench>("wrench");
    CHECK(off(poses[99]) > 1.2 * mm);
    CHECK(off(poses[880]) < 0.6 * off(poses[99]));
    CHECK(off(poses.back()) < 0.15 * mm);
    CHECK(session.node.last<double>("score") > 0.7);
    // Felt while held, gone once the springs gave way, and never in steps.
    CHECK(glm::length(felt[880].force) > 0.3);
    CHECK(glm::length(felt.back().force) < 1e-6);
    double step = 0.0, ripple = 0.0;
    for (std::size_t k = 1; k < felt.size(); ++k) step = std::max(step, glm::length(felt[k].force - felt[k - 1].force));
    for (std::size_t k = 780; k < 880; ++k) ripple = std::max(ripple, glm::length(felt[k].force - felt[880].force));
    CHECK(step < 0.5);
    CHECK(ripple < 5e-3);
}

TEST_CASE("the hand can always pull a fragment out of its fit") {
    // Fitted first, then drawn away by 20 mm within a second.
    Session session(
        [](std::int64_t k) {
            const double away = std::clamp(0.02 * static_cast<double>(k - 500), 0.0, 20.0) * mm;
            return Pose{Vec3(away, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}} * grip.inverse();
        },
        1700, 0, 1'000'000);
    const auto felt = session.node.values<Wrench>("wrench");
    double most = 0.0;
    for (const Wrench& w : felt) most = std::max(most, glm::length(w.force));
    CHECK(most > 2.0);
    CHECK(most < 10.5);
    CHECK(glm::length(felt.back().force) < 0.05);
    CHECK(session.node.last<Pose>("pose").position.x == Approx(20.0 * mm).margin(0.1 * mm));
}

TEST_CASE("a fragment follows the hand while the pull is 0 N, and is drawn once it is not") {
    NodeHarness node("snap_to_fit", test::servo);
    node.asset("moving", fracture().right).asset("fixed", fracture().left);
    node.set("held", "1").set("target", "0").set("force", "0 N");
    node.feed("scene", fracture().scene).feed("grip", grip);
    // From 10 mm away to beside its place.
    node.feed<Pose>("device", [](std::int64_t k) {
        const double away = std::max(10.0 - 0.02 * static_cast<double>(k), 0.0) * mm;
        return Pose{beside.position + Vec3(away, 0.0, 0.0), beside.orientation};
    });
    node.disconnect("holding").disconnect("strength").disconnect("engaged").disconnect("settle");
    node.prepare();
    node.run(700);
    const double without = off(node.last<Pose>("pose"));
    CHECK(without > 1.2 * mm);
    CHECK(without < 3.0 * mm);
    CHECK(node.last<double>("pull") == 0.0);
    node.set("force", "10 N");
    node.run(900);
    CHECK(off(node.last<Pose>("pose")) < 0.6 * without);
    CHECK(node.last<double>("pull") > 0.0);
}

TEST_CASE("a fragment that nothing draws stays in the hand, settle or not") {
    for (const bool has_target : {true, false}) {
        CAPTURE(has_target);
        NodeHarness node("snap_to_fit", test::servo);
        node.asset("moving", fracture().right).asset("fixed", fracture().left);
        node.set("held", "1").set("target", has_target ? "0" : "1");
        node.feed("scene", fracture().scene).feed("grip", grip);
        node.feed<Pose>("device", [](std::int64_t k) {
            const double away = (20.0 + 0.02 * static_cast<double>(k)) * mm;
            return Pose{Vec3(away, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}} * grip.inverse();
        });
        node.feed<bool>("engaged", !has_target).feed<bool>("settle", true);
        node.disconnect("holding").disconnect("strength");
        node.prepare();
        node.run(300);
        CHECK(node.last<Pose>("pose").position.x == Approx(25.98 * mm).margin(0.01 * mm));
    }
}

TEST_CASE("a fragment that is let go while it is pulled leaves no force on the hand") {
    NodeHarness node("snap_to_fit", test::servo);
    node.asset("moving", fracture().right).asset("fixed", fracture().left);
    node.set("held", "1").set("target", "0");
    node.feed("scene", fracture().scene).feed("device", beside).feed("grip", grip).feed("engaged", true);
    node.feed<bool>("holding", [](std::int64_t k) { return k < 600; });
    node.disconnect("settle").disconnect("strength");
    node.prepare();
    node.run(720);
    const auto felt = node.values<Wrench>("wrench");
    const double held = glm::length(felt[599].force);
    double step = 0.0;
    for (std::size_t k = 600; k < felt.size(); ++k)
        step = std::max(step, glm::length(felt[k].force - felt[k - 1].force));
    CAPTURE(held, step);
    CHECK(held > 0.5);
    CHECK(step < 0.02 * held);
    CHECK(felt[701].force == Vec3(0.0));
    CHECK(felt.back().torque == Vec3(0.0));
}

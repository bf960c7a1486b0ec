// SPDX-License-Identifier: Apache-2.0
// Pegs, thin plates and broken bones: the couplings where they are hard.
#include "assets/library/fragments.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/quantile.hpp"
#include "dsp/coupling/held_contact.hpp"
#include "tests/dsp/coupling/held.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

struct Part {
    contact::Pointshell shell;
    contact::Voxmap map;
};

template <class Shape>
Part part_of(const Shape& shape, double spacing, double voxel) {
    return {test::shell_of(shape, spacing), test::map_of(shape, voxel)};
}

/// Place 0 stands, place 1 is held.
coupling::Scene scene_of(const Part& still, const Part& held) {
    coupling::Scene scene;
    scene.count = 2;
    scene.objects[0].body = {&still.shell, &still.map, nullptr, {}, 1, 1};
    scene.objects[1].body = {&held.shell, &held.map, nullptr, {}, 1, 2};
    return scene;
}

struct Rig {
    coupling::Scene scene;
    coupling::HeldContact contact{200000};
    coupling::QuasiStaticCoupling coupling;
    SizeCounts residuals;
    double balanced = 0.0, deepest = 0.0;

    Rig(const Part& still, const Part& held, const Pose& grip, const contact::ContactLaw& law, const Pose& start)
        : scene(scene_of(still, held)) {
        contact.set(scene, 1, grip, law, false);
        coupling.settings.reach = contact.reach();
        coupling.settings.gyration = contact.gyration();
        coupling.settings.springs = {{1000.0, 60.0}, {1.0, 5.0}};
        coupling.reset(start);
    }
    const coupling::QuasiStaticState& update(const Pose& hand) {
        const coupling::QuasiStaticState& now = coupling.update(hand, contact);
        residuals.add(now.residual);
        balanced += now.balanced ? 1.0 : 0.0;
        deepest = std::max(deepest, now.contact.penetration);
        return now;
    }
    double share() const { return balanced / static_cast<double>(residuals.total()); }
};

contact::ContactLaw stiff() {
    contact::ContactLaw law;
    law.stiffness = 100e3;
    law.interpolation = contact::Interpolation::quadratic;
    law.blend = 0.01 * mm;
    return law;
}

struct Insertion {
    double depth = 0.0, end = 0.0, axial = 0.0, lateral = 0.0;
};

/// A peg of 10 mm goes 20 mm down and comes up again under a hand that shakes by 0.8 mm and 2 degrees.
Insertion insert(double clearance) {
    const Part hole =
        part_of(contact::make_bushing(10.0 * mm + clearance, 26.0 * mm, 30.0 * mm, 1.0 * mm), 0.42 * mm, 0.25 * mm);
    const Part peg = part_of(contact::make_cylinder(10.0 * mm, 30.0 * mm, 0.5 * mm), 0.42 * mm, 0.25 * mm);
    const Pose grip{{0.0, 0.0, -30.0 * mm}, {1, 0, 0, 0}};
    Rig rig(hole, peg, grip, stiff(), {{0.0, 0.0, 33.0 * mm}, {1, 0, 0, 0}});
    rig.coupling.settings.springs.linear.limit = 15.0;
    Insertion result{-1.0, 0.0, 0.0, 0.0};
    for (int n = 0; n < 3000; ++n) {
        const double t = n * 1e-3, w = 2.0 * std::numbers::pi * 1.5;
        const double depth = n < 1500 ? -3.0 * mm + 24.0 * mm * t / 1.5 : 21.0 * mm - 24.0 * mm * (t - 1.5) / 1.5;
        const Vec3 shake = 0.8 * mm * Vec3(std::sin(w * t), std::sin(1.3 * w * t), 0.0);
        const Vec3 nod = 2.0 * degree * Vec3(std::sin(1.3 * w * t), std::sin(w * t), 0.0);
        const coupling::QuasiStaticState& now =
            rig.update({Vec3(0.0, 0.0, 30.0 * mm - depth) + shake, rotation_by(nod)});
        REQUIRE(is_finite(now.wrench));
        const Vec3 tip = (now.proxy * grip).position;
        result.depth = std::max(result.depth, -tip.z);
        result.axial = std::max(result.axial, std::abs(now.wrench.force.z));
        if (-tip.z > 2.0 * mm) result.lateral = std::max(result.lateral, std::hypot(tip.x, tip.y));
        result.end = -tip.z;
    }
    return result;
}

void check_insertion(double clearance) {
    const Insertion peg = insert(clearance);
    CAPTURE(clearance, peg.depth, peg.axial, peg.lateral, peg.end);
    CHECK(peg.depth >= 20.0 * mm - 0.1 * mm);
    CHECK(peg.axial <= 10.0);
    CHECK(peg.lateral <= clearance + 0.02 * mm);
    CHECK(peg.end < 0.0);
}

}  // namespace

TEST_CASE("a peg goes in and comes out without clearance", "[slow]") { check_insertion(0.0); }

TEST_CASE("a peg goes in and comes out at 0.3 and 0.1 mm of clearance, and not at -0.1 mm", "[long]") {
    for (const double clearance : {0.3 * mm, 0.1 * mm}) check_insertion(clearance);
    const Insertion tight = insert(-0.1 * mm);
    CAPTURE(tight.depth, tight.axial);
    CHECK(tight.depth < 10.0 * mm);
}

namespace {

/// Presses a cube with its face and with its corner on a plate of that thickness.
void press_through(double wall) {
    const Part block = part_of(contact::Box{{6.0 * mm, 6.0 * mm, 6.0 * mm}}, 0.42 * mm, 0.35 * mm);
    const Quat on_corner = rotation_by(Vec3(0.0, -std::acos(1.0 / std::sqrt(3.0)), 0.0)) *
                           rotation_by(Vec3(0.0, 0.0, -0.25 * std::numbers::pi));
    const Part plate = part_of(contact::Box{{24.0 * mm, 24.0 * mm, wall}}, 1.0 * mm, 0.175 * mm);
    for (const bool corner : {false, true}) {
        contact::ContactLaw law;
        law.blend = 0.0;
        const Quat turn = corner ? glm::conjugate(on_corner) : Quat(1, 0, 0, 0);
        Rig rig(plate, block, {}, law, {{0.1 * mm, 0.2 * mm, 12.0 * mm}, turn});
        rig.coupling.settings.step = 0.25 * mm;
        rig.coupling.settings.springs.linear.limit = corner ? 0.9 * law.stiffness * wall / 2.0 : 40.0;
        rig.coupling.settings.springs.angular = {100.0, 100.0};
        for (int n = 0; n < 4000; ++n) rig.update({{0.1 * mm, 0.2 * mm, 12.0 * mm - 0.015 * mm * n}, turn});
        CAPTURE(wall, corner, rig.deepest);
        CHECK(rig.coupling.state().proxy.position.z > 0.5 * wall);
        CHECK(rig.coupling.state().contact.in_contact > 0);
    }
}

}  // namespace

TEST_CASE("no corner pops through a plate of 0.7 mm below the documented force, no face at all", "[slow]") {
    press_through(0.7 * mm);
}

TEST_CASE("no corner pops through a plate of 1 or 2 mm below the documented force, no face at all", "[long]") {
    for (const double wall : {2.0 * mm, 1.0 * mm}) press_through(wall);
}

TEST_CASE("a plate of 1 mm does not go through a plate of 1 mm at any speed up to 2 m/s") {
    const Part still = part_of(contact::Box{{24.0 * mm, 24.0 * mm, 1.0 * mm}}, 0.5 * mm, 0.25 * mm);
    const Part held = part_of(contact::Box{{12.0 * mm, 12.0 * mm, 1.0 * mm}}, 0.5 * mm, 0.25 * mm);
    for (const double speed : {0.2, 0.5, 1.0, 2.0}) {
        Rig rig(still, held, {}, stiff(), {{0.0, 0.0, 20.0 * mm}, {1, 0, 0, 0}});
        rig.coupling.settings.springs.linear.limit = 20.0;
        const int ticks = static_cast<int>(40.0 * mm / speed / 1e-3) + 200;
        for (int n = 0; n < ticks; ++n)
            rig.update({{0.0, 0.0, std::max(-20.0 * mm, 20.0 * mm - speed * 1e-3 * n)}, {1, 0, 0, 0}});
        CAPTURE(speed);
        CHECK(rig.coupling.state().proxy.position.z > 0.8 * mm);
    }
}

namespace {

/// The two halves of the bundled fracture, about their middles.
struct Halves {
    Part left, right;
    Pose left_at, right_at;

    Halves() {
        std::vector<bone::Bone> bones = library::make_fragments();
        take(bones[0], left, left_at);
        take(bones[1], right, right_at);
    }
    static void take(bone::Bone& bone, Part& part, Pose& at) {
        Vec3 middle(0.0);
        for (const contact::SurfacePoint& p : bone.points) middle += p.position;
        middle /= static_cast<double>(bone.points.size());
        for (contact::SurfacePoint& p : bone.points) p.position -= middle;
        bone.distance.origin -= middle;
        part = {contact::make_pointshell(bone.points), contact::make_voxmap(std::move(bone.distance))};
        at.position = middle;
    }
};

const Halves& halves() {
    static const Halves both;
    return both;
}

Rig fragment_rig(const contact::ContactLaw& law) {
    const Halves& h = halves();
    Rig rig(h.left, h.right, {}, law, {h.right_at.position + Vec3(3.0 * mm, 0, 0), {1, 0, 0, 0}});
    rig.scene.objects[0].pose = h.left_at;
    rig.contact.set(rig.scene, 1, {}, law, false);
    return rig;
}

}  // namespace

TEST_CASE("a jump of 15 mm and 14 degrees leaves a fragment on its side", "[slow]") {
    Rig rig = fragment_rig({});
    const Vec3 fit = halves().right_at.position;
    for (int n = 0; n < 20; ++n) rig.update({fit, {1, 0, 0, 0}});
    const Pose deep{fit - Vec3(15.0 * mm, 0.0, 0.0), rotation_by({0.0, 0.14, 0.2})};
    for (int n = 0; n < 100; ++n) rig.update(deep);
    CHECK(rig.coupling.state().proxy.position.x > fit.x - 3.0 * mm);
    CHECK(rig.coupling.state().wrench.force.x > 5.0);
}

TEST_CASE("fragments slide and walk on each other: balanced, not deep, and silent when held", "[slow]") {
    const Vec3 fit = halves().right_at.position;
    for (const bool is_stiff : {false, true}) {
        const contact::ContactLaw law = is_stiff ? stiff() : contact::ContactLaw{};
        {
            Rig rig = fragment_rig(law);
            // 40 mm/s along the fracture at about 3.5 N.
            for (int n = 0; n < 1500; ++n) {
                const double press = std::min(3.5 * mm, 0.01 * mm * n);
                const double along = 6.0 * mm * std::sin(40.0 / 6.0 * 1e-3 * n);
                rig.update({fit + Vec3(3.0 * mm - press - 2.0 * mm, 0.0, along), {1, 0, 0, 0}});
            }
            CAPTURE(is_stiff, rig.share(), rig.residuals.quantile(0.99), rig.deepest);
            CHECK(rig.share() >= 0.9);
            CHECK(rig.residuals.quantile(0.99) < (is_stiff ? 0.05 : 0.1));
            CHECK(rig.deepest < (is_stiff ? 0.15 : 0.45) * mm);
        }
        Rig rig = fragment_rig(law);
        Pose hand;
        for (int n = 0; n < 3000; ++n) {
            const double t = n * 1e-3, w = 2.0 * std::numbers::pi;
            hand.position = fit + mm * Vec3(-1.0 + 2.0 * std::sin(0.7 * w * t) + 0.5 * std::sin(2.9 * w * t),
                                            2.0 * std::sin(0.9 * w * t + 1.0), 2.0 * std::sin(1.1 * w * t + 2.0));
            hand.orientation = rotation_by(
                degree * Vec3(3.0 * std::sin(0.8 * w * t), 3.0 * std::sin(1.2 * w * t), 4.0 * std::sin(0.6 * w * t)));
            rig.update(hand);
        }
        CAPTURE(is_stiff, rig.share(), rig.residuals.quantile(0.99), rig.deepest);
        CHECK(rig.share() >= 0.9);
        CHECK(rig.residuals.quantile(0.99) < 1.0);
        CHECK(rig.deepest < (is_stiff ? 0.15 : 0.45) * mm);
        for (int n = 0; n < 300; ++n) rig.update(hand);
        const Wrench held = rig.coupling.state().wrench;
        for (int n = 0; n < 1000; ++n) REQUIRE(glm::length(rig.update(hand).wrench.force - held.force) < 1e-6);
    }
}

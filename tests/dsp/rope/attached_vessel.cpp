// SPDX-License-Identifier: Apache-2.0
// A vessel that is attached to pieces: what is free, what it pulls, how far it reaches.
#include "dsp/rope/attached_vessel.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace tactus;
using rope::AttachedVessel;
using rope::AttachedVesselSettings;
using rope::Attachment;

namespace {

/// Along z from 200 mm down to 0, a point per millimetre.
std::vector<Vec3> straight() {
    std::vector<Vec3> line;
    for (int n = 0; n <= 200; ++n) line.push_back({0.0, 0.0, (200.0 - n) * mm});
    return line;
}

/// Points on a cylinder about (-8 mm, 0) of 5 mm radius from `low` to `high`.
std::vector<Vec3> cylinder(double low, double high) {
    std::vector<Vec3> points;
    for (double z = low; z <= high + 1e-9; z += 0.5 * mm)
        for (int k = 0; k < 48; ++k) {
            const double a = 2.0 * std::numbers::pi * k / 48.0;
            points.push_back({-8.0 * mm + 5.0 * mm * std::cos(a), 5.0 * mm * std::sin(a), z});
        }
    return points;
}

/// Weightless, frictionless, unbending: tension is what stretch says.
AttachedVesselSettings plain(double pedicle = 0.0) {
    AttachedVesselSettings settings;
    settings.material.bending = settings.material.weight = settings.material.friction = 0.0;
    settings.pedicle = pedicle;
    return settings;
}

/// Two pieces of 30 mm with a wedge of 4 mm between them; the pedicle is what is above 100 mm.
struct HeldFlap {
    std::vector<Vec3> line = straight();
    std::vector<std::vector<Vec3>> surfaces{{}, cylinder(36.0 * mm, 66.0 * mm), cylinder(70.0 * mm, 100.0 * mm)};
    std::vector<Attachment> attached = rope::attachments_along(line, surfaces, 12.0 * mm);
    std::vector<Pose> poses{3, Pose{}};
};

void settle(AttachedVessel& vessel, const std::vector<Pose>& poses, const Vec3* site, int ticks = 800) {
    for (int n = 0; n < ticks; ++n) vessel.step(1e-3, poses, site, nullptr);
}

}  // namespace

TEST_CASE("a vessel is attached where it runs beside a piece, and free from its cuts on") {
    const HeldFlap flap;
    REQUIRE(flap.attached.size() == 2);
    // In the order of the course, which begins above.
    CHECK(flap.attached[0].body == 2);
    CHECK(flap.attached[1].body == 1);
    for (const auto& [n, high, low] : {std::tuple{0, 100.0, 70.0}, std::tuple{1, 66.0, 36.0}}) {
        const Attachment& a = flap.attached[static_cast<std::size_t>(n)];
        CHECK(flap.line[a.first].z * 1e3 == Approx(high).margin(1.6));
        CHECK(flap.line[a.last].z * 1e3 == Approx(low).margin(1.6));
    }
    // Too far away, and none at all.
    CHECK(rope::attachments_along(flap.line, flap.surfaces, 2.0 * mm).empty());
    CHECK_THROWS_AS(AttachedVessel(flap.line, {}, flap.poses, plain()), Error);
}

TEST_CASE("pieces that share a part of a course get parts that follow each other") {
    // The whole bone, and two pieces cut from it.
    const HeldFlap flap;
    auto surfaces = flap.surfaces;
    surfaces[0] = cylinder(10.0 * mm, 120.0 * mm);
    surfaces.push_back(cylinder(5.0 * mm, 50.0 * mm));
    const auto attached = rope::attachments_along(flap.line, surfaces, 12.0 * mm);
    REQUIRE(attached.size() >= 2);
    for (std::size_t n = 1; n < attached.size(); ++n) CHECK(attached[n].first > attached[n - 1].last);
    CHECK_NOTHROW(AttachedVessel(flap.line, attached, std::vector<Pose>(4), plain()));
}

TEST_CASE("a long pedicle and all spans have no more points than asked") {
    const HeldFlap flap;
    AttachedVesselSettings settings = plain();
    settings.max_points = 30;
    const std::vector<Attachment> apart{{2, 100, 120}, {1, 150, 164}};
    const AttachedVessel vessel(flap.line, apart, flap.poses, settings);
    CHECK(vessel.rope().points().size() == 30);
    // Of a course that begins and ends on one piece, nothing is free.
    const std::vector<Vec3> on_bone(flap.line.begin() + 110, flap.line.begin() + 120);
    CHECK_THROWS_AS(AttachedVessel(on_bone, std::vector<Attachment>{{2, 0, 9}}, flap.poses, plain()), Error);
}

TEST_CASE("a pedicle held at its length in the leg bears the tension of the leg, and no more is felt by the pieces") {
    const HeldFlap flap;
    AttachedVessel vessel(flap.line, flap.attached, flap.poses, plain());
    const Vec3 site = flap.line.front();
    settle(vessel, flap.poses, &site);
    REQUIRE(vessel.is_sewn());
    const double in_leg = 3.6e-6 * 62e3 / 0.12 * (1.0 / 0.89 - 1.0);
    CHECK(vessel.tension() == Approx(in_leg).epsilon(0.002));
    CHECK(vessel.strain(&site) == Approx(1.0 / 0.89 - 1.0).epsilon(0.002));
    CHECK(rope::reach_of(vessel.strain(&site)) == rope::Reach::in_situ);
    // The upper piece is pulled up by the pedicle and down by the span, the lower one up by the span.
    const Wrench upper = vessel.pull_on(2, Vec3(0.0)), lower = vessel.pull_on(1, Vec3(0.0));
    CHECK(glm::length(lower.force - Vec3(0.0, 0.0, vessel.span_tension())) < 1e-4);
    CHECK(glm::length(upper.force + lower.force - Vec3(0.0, 0.0, in_leg)) < 1e-3);
    CHECK(vessel.pull_on(0, Vec3(0.0)).force == Vec3(0.0));
    // About a point beside it, the torque is arm × force.
    const Wrench beside = vessel.pull_on(2, Vec3(50.0 * mm, 0.0, 0.0));
    CHECK(beside.torque.y == Approx(50.0 * mm * upper.force.z + vessel.pull_on(2, Vec3(0.0)).torque.y).margin(1e-12));
    CHECK(vessel.pull_on(1, Vec3(50.0 * mm, 0.0, 0.0)).torque.y == Approx(50.0 * mm * lower.force.z).epsilon(1e-3));
}

TEST_CASE("a vessel's reach changes from slack to none at the lengths that are stated") {
    const HeldFlap flap;
    AttachedVessel vessel(flap.line, flap.attached, flap.poses, plain(80.0 * mm));
    CHECK(vessel.pedicle_rest() == Approx(0.89 * 80.0 * mm).epsilon(0.003));
    const double root = flap.line[flap.attached[0].first].z;
    for (const auto& [share, wanted] : {std::pair{0.86, rope::Reach::slack}, std::pair{0.92, rope::Reach::in_situ},
                                        std::pair{0.99, rope::Reach::in_situ}, std::pair{1.01, rope::Reach::stretched},
                                        std::pair{1.09, rope::Reach::stretched}, std::pair{1.11, rope::Reach::no}}) {
        CAPTURE(share);
        const Vec3 site(0.0, 0.0, root + share * 80.0 * mm);
        // Before it is sewn the straight way counts.
        CHECK(rope::reach_of(vessel.strain(&site)) == wanted);
        settle(vessel, flap.poses, &site);
        CHECK(vessel.is_sewn());
        CHECK(rope::reach_of(vessel.strain(&site)) == wanted);
        CHECK((vessel.tension() > 1e-3) == (wanted != rope::Reach::slack));
        settle(vessel, flap.poses, nullptr, 2);
        CHECK_FALSE(vessel.is_sewn());
    }
}

TEST_CASE("moving the first cut distally lengthens the pedicle") {
    HeldFlap flap;
    const AttachedVessel before(flap.line, flap.attached, flap.poses, plain());
    flap.surfaces[2] = cylinder(70.0 * mm, 90.0 * mm);
    const AttachedVessel after(flap.line, rope::attachments_along(flap.line, flap.surfaces, 12.0 * mm), flap.poses,
                               plain());
    CHECK(after.pedicle_rest() - before.pedicle_rest() == Approx(0.89 * 10.0 * mm).margin(0.2 * mm));
}

TEST_CASE("a piece that turns about its axis twists the pedicle by as much") {
    const HeldFlap flap;
    AttachedVessel vessel(flap.line, flap.attached, flap.poses, plain(60.0 * mm));
    const Vec3 site(0.0, 0.0, 150.0 * mm);
    settle(vessel, flap.poses, &site);
    REQUIRE(vessel.is_sewn());
    CHECK(std::abs(vessel.twist()) < 1e-6);
    std::vector<Pose> poses = flap.poses;
    // More than a whole turn.
    for (int n = 1; n <= 600; ++n) {
        const Quat turn = rotation_by(Vec3(0.0, 0.0, n / 600.0 * 2.25 * std::numbers::pi));
        poses[1].orientation = poses[2].orientation = turn;
        vessel.step(1e-3, poses, &site, nullptr);
    }
    CHECK(std::abs(vessel.twist()) == Approx(2.25 * std::numbers::pi).epsilon(0.02));
}

TEST_CASE("a vessel in a tick allocates nothing, and poses that are none change nothing") {
    const HeldFlap flap;
    AttachedVessel vessel(flap.line, flap.attached, flap.poses, {});
    const Vec3 site = flap.line.front();
    settle(vessel, flap.poses, &site);
    const double before = vessel.tension();
    std::vector<Pose> poses = flap.poses;
    poses[2].position.x = std::numeric_limits<double>::quiet_NaN();
    const Vec3 nowhere(std::numeric_limits<double>::infinity(), 0.0, 0.0);
    rope::RopeShape shape;
    const RealtimeViolations seen = watch([&] {
        vessel.step(1e-3, poses, &site, nullptr);
        vessel.step(1e-3, flap.poses, &nowhere, nullptr);
        vessel.step(1e-3, flap.poses, &site, nullptr);
        vessel.show(shape);
    });
    CHECK(seen.describe() == "none");
    settle(vessel, flap.poses, &site);
    CHECK(vessel.tension() == Approx(before).epsilon(1e-3));
    CHECK(shape.count == vessel.rope().points().size());
    CHECK(is_finite(vessel.pull_on(2, Vec3(0.0))));
}

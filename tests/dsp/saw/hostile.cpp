// SPDX-License-Identifier: Apache-2.0
// Saw and burr under inputs that no hand should make.
#include "dsp/saw/burr.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
const double infinite = std::numeric_limits<double>::infinity();

bool is_sane(const Wrench& wrench) { return is_finite(wrench.force) && is_finite(wrench.torque); }

/// Poses that are none, or far from all bone.
const std::vector<Pose>& hostile_poses() {
    static const std::vector<Pose> all{
        {Vec3(nan_value, 0.0, 0.0), teeth_down},
        {Vec3(0.0, infinite, 0.0), teeth_down},
        {Vec3(0.0, 0.0, -1e300), teeth_down},
        {Vec3(0.0), Quat(0.0, 0.0, 0.0, 0.0)},
        {Vec3(0.0), Quat(nan_value, 0.0, 0.0, 1.0)},
        {Vec3(0.0), Quat(1e200, 0.0, 0.0, 0.0)},
        {Vec3(0.0, 0.0, -0.004), Quat(2.0, 0.0, 0.0, 0.0)},
    };
    return all;
}

}  // namespace

TEST_CASE("teeth that cut as deep as a tooth can keep a finite force that the law allows") {
    // Soft bone: every tooth is beyond the end of the law, and a tick passes a place many times. The blade stands exactly
    // along the axes, so that nothing of a lag is left when a tooth has cut all of it.
    for (const auto& [tick, cycles] : {std::pair{250.0, 1000.0}, std::pair{20.0, 228.0}, std::pair{1000.0, 2000.0}})
        for (const double push : {0.02e-3, 0.1e-3, 0.9e-3}) {
            const auto bone = bone_block(
                {.low = {-0.006, 0.0, -0.004}, .high = {0.006, 0.008, 0.004}, .voxel = 0.33e-3, .density = 60.0});
            Sawing sawing(*bone, tick, 40e3);
            sawing.drive.rate = cycles;
            const saw::CuttingLaw law;
            for (int n = 0; n < 60; ++n) {
                const Vec3 at(0.0, std::min(-0.3e-3 + push * n, 4e-3), 0.0);
                const saw::SawContact now = sawing.step({at, Quat(1.0, 0.0, 0.0, 0.0)});
                CAPTURE(tick, cycles, push, n, now.feed);
                REQUIRE(is_sane(now.wrench));
                REQUIRE(std::isfinite(now.thrust));
                REQUIRE(now.feed <= 1.001 * 2.0 * cycles * law.deepest);
                for (const saw::Tooth& tooth : sawing.blade.teeth().teeth()) REQUIRE(is_finite(tooth.at));
            }
            CHECK(sawing.removed > 0.0);
        }
}

TEST_CASE("what a cut leaves of a spring satisfies the law at any force and any number of passes") {
    const saw::CuttingLaw law;
    for (const double stiff : {1e3, 1e5, 1e7})
        for (const double lag : {1e-7, 1e-5, 1e-3, 1e-2})
            for (const double passes : {1e-3, 0.456, 8.0, 500.0}) {
                const double left =
                    saw::left_after_cut(law, lag, passes, [&](double u) { return std::pair{stiff * u, stiff}; });
                const double miss = lag - left - passes * law.depth(stiff * left).depth;
                CAPTURE(stiff, lag, passes, left, miss);
                CHECK(left >= 0.0);
                CHECK(left <= lag);
                // Steep lines: the place is met to 4e-9 m.
                CHECK(std::abs(miss) < 1e-9 + 4e-9 * (1.0 + passes * stiff * 4e-6));
            }
}

TEST_CASE("a burr in soft bone is finite, and bone without density does not hold it") {
    for (const double density : {0.0, 60.0}) {
        const auto bone = bone_block({.voxel = 0.33e-3, .density = density});
        saw::Burr burr({0.002, 8.0}, 20e3);
        double most = 0.0, feed = 0.0;
        for (int n = 0; n < 400; ++n) {
            const double z = 0.0025 - 0.01e-3 * n;
            const saw::BurrContact now =
                burr.step(bone->current(), {Vec3(0.0, 0.0, z), teeth_down}, {true, 1000.0, 1e-3}, {});
            REQUIRE(is_sane(now.wrench));
            most = std::max(most, now.load);
            feed = std::max(feed, now.feed);
        }
        CAPTURE(density, most, feed);
        if (density == 0.0) CHECK(most < 1e-9);
        else CHECK(most > 0.0);
        // As fast as it is pushed, and not to and fro.
        CHECK(feed < 0.02);
    }
}

TEST_CASE("a blade that is swept fast through air beside the bone feels nothing") {
    for (const double voxel : {0.16e-3, 0.4e-3})
        for (const Vec3& way : {Vec3(2.0e-3, 0.0, 0.0), Vec3(0.0, 2.0e-3, 0.0)}) {
            const auto bone = bone_block({.low = {-0.006, -0.004, -0.003}, .voxel = voxel});
            Sawing sawing(*bone);
            // The front is half a kerf above the teeth.
            for (int n = -10; n <= 10; ++n) {
                const saw::SawContact now = sawing.step({Vec3(0.0, 0.0, 0.4e-3) + way * double(n), teeth_down});
                CAPTURE(voxel, way.x, way.y, n, now.lag);
                CHECK(glm::length(now.wrench.force) < 1e-9);
            }
        }
}

TEST_CASE("poses that are none give no force, and the blade lets go of the bone") {
    const auto bone = bone_block({.voxel = 0.33e-3});
    for (const Pose& hostile : hostile_poses()) {
        Sawing sawing(*bone);
        saw::Burr burr({0.002, 8.0}, 20e3);
        Pushing hand;
        hand.push(sawing, 5.0, 0.3);
        for (int n = 0; n < 3; ++n) {
            const saw::SawContact now = sawing.step(hostile);
            CAPTURE(hostile.position.x, hostile.position.z, hostile.orientation.w);
            CHECK(is_sane(now.wrench));
            CHECK(glm::length(now.wrench.force) < 1e-9);
            const saw::BurrContact ball = burr.step(sawing.read, hostile, {true, 1000.0, 1e-3}, {});
            CHECK(glm::length(ball.wrench.force) < 1e-9);
        }
        // Nothing is left of it.
        const saw::SawContact after = sawing.step({Vec3(0.0, 0.0, 0.005), teeth_down});
        CHECK(glm::length(after.wrench.force) == 0.0);
        CHECK(std::isfinite(sawing.removed));
    }
}

TEST_CASE("a pose far from all bone lets the force fade within 100 ms") {
    const auto bone = bone_block({.voxel = 0.33e-3});
    Sawing sawing(*bone);
    Pushing hand;
    hand.push(sawing, 5.0, 0.3);
    double last = 6.0;
    for (int n = 0; n < 120; ++n) {
        const double force = glm::length(sawing.step({Vec3(5.0, -3.0, 900.0), teeth_down}).wrench.force);
        REQUIRE(force <= last);
        last = force;
    }
    CHECK(last == 0.0);
}

TEST_CASE("ticks without length, rates that are none and a bone without samples are harmless") {
    const auto bone = bone_block({.voxel = 0.33e-3});
    for (const double bad : {0.0, -1.0, nan_value, infinite}) {
        Sawing sawing(*bone);
        Pushing hand;
        hand.push(sawing, 5.0, 0.3);
        sawing.drive.dt = bad;
        CHECK(is_sane(sawing.step({hand.position, teeth_down}).wrench));
        sawing.drive = {true, bad, 1e-3};
        for (int n = 0; n < 5; ++n) {
            const saw::SawContact now = sawing.step({hand.position - Vec3(0.0, 0.0, 1e-5 * n), teeth_down});
            CAPTURE(bad);
            CHECK(is_sane(now.wrench));
            CHECK(std::isfinite(now.feed));
        }
    }
    const volume::BoneSnapshot none;
    saw::SawBlade blade({}, 20e3);
    saw::Burr burr({0.002, 8.0}, 20e3);
    for (int n = 0; n < 5; ++n) {
        const Pose pose{Vec3(0.0, 0.0, -1e-4 * n), teeth_down};
        CHECK(glm::length(blade.step(none, pose, {true, 228.0, 1e-3}, {}).wrench.force) == 0.0);
        CHECK(glm::length(burr.step(none, pose, {true, 1000.0, 1e-3}, {}).wrench.force) == 0.0);
    }
}

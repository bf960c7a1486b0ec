// SPDX-License-Identifier: Apache-2.0
// A blade and a burr are solid all over.
#include "dsp/core/random.hpp"
#include "dsp/saw/burr.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using namespace tactus::test;

namespace {

const BoneBox block{.low = {-0.006, -0.005, -0.008}, .high = {0.006, 0.005, 0.0}, .voxel = 0.4e-3, .margin = 0.004};

/// Greatest depth in the block of a grid of points in the box of a blade, m.
double depth_of_blade(const saw::SawShape& shape, const Pose& pose) {
    double deepest = -1.0;
    for (int i = 0; i <= 80; ++i)
        for (int j = 0; j <= 24; ++j)
            for (const double z : {-0.5, 0.5}) {
                const double x = shape.length * (i / 80.0 - 0.5);
                const double y = -shape.behind(x) - (shape.height - shape.behind(x)) * j / 24.0;
                const Vec3 p = pose.apply({x, y, z * shape.thickness});
                const Vec3 in = glm::min(p - block.low, block.high - p);
                deepest = std::max(deepest, std::min({in.x, in.y, in.z}));
            }
    return deepest;
}

double depth_of_burr(const Pose& pose) {
    double deepest = -1.0;
    const auto see = [&](const Vec3& local, double radius) {
        const Vec3 p = pose.apply(local), q = glm::max(block.low - p, p - block.high);
        const double distance = glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
        deepest = std::max(deepest, radius - distance);
    };
    see({0.0, 0.0, 0.0}, 0.002);
    for (int n = 0; n <= 40; ++n) see({0.0, -0.002 - n * 0.0006, 0.0}, 0.001175);
    return deepest;
}

Quat random_turn(const Random& random, std::uint64_t n) {
    return glm::normalize(Quat(random.normal(n), random.normal(n + 1), random.normal(n + 2), random.normal(n + 3)));
}

}  // namespace

TEST_CASE("no part of a blade or a burr sinks into bone without force, at any attitude", "[slow]") {
    const auto bone = bone_block(block);
    const Random random{3};
    saw::SawShape sagittal;
    sagittal.kind = saw::SawKind::sagittal;
    sagittal.length = 0.012;
    sagittal.height = 0.030;
    sagittal.thickness = 0.0008;
    int pressed = 0;
    for (std::uint64_t n = 0; n < 75; ++n) {
        const int tool = static_cast<int>(n % 3);  // blade, sagittal blade, burr
        const saw::SawShape shape = tool == 1 ? sagittal : saw::SawShape{};
        saw::SawBlade blade(shape, 20e3);
        saw::Burr burr({0.002, 8.0}, 20e3);
        const Quat turn = random_turn(random, 50 * n);
        // Some place of the tool goes to some place within the block, from outside, straight.
        const Vec3 local = tool == 2 ? Vec3(0.0, -0.020 * random.uniform(50 * n + 4), 0.0)
                                     : Vec3(shape.length * (random.uniform(50 * n + 4) - 0.5),
                                            -shape.height * random.uniform(50 * n + 5), 0.0);
        const Vec3 goal(0.008 * (random.uniform(50 * n + 6) - 0.5), 0.006 * (random.uniform(50 * n + 7) - 0.5), -0.003);
        const Vec3 from = glm::normalize(
            Vec3(random.normal(50 * n + 8), random.normal(50 * n + 9), 0.3 + std::abs(random.normal(50 * n + 10))));
        const Vec3 end = goal - turn * local;
        Vec3 at = end + 0.07 * from, last_force(0.0), last = at;
        double work = 0.0, bound = 0.0;
        const auto go = [&](double share, bool approaches) {
            last = at;
            at = end + 0.07 * from * share;
            const Pose pose{at, turn};
            const auto [force, magnitudes] = [&] {
                if (tool == 2) {
                    const saw::BurrContact now = burr.step(bone->current(), pose, {false, 0.0, 1e-3}, {});
                    return std::pair{now.wrench.force, now.magnitudes};
                }
                const saw::SawContact now = blade.step(bone->current(), pose, {false, 0.0, 1e-3}, {});
                return std::pair{now.wrench.force, now.magnitudes};
            }();
            work += glm::dot(last_force, at - last);
            bound += 0.5 *
                     std::min(std::abs(glm::dot(force - last_force, at - last)), 20e3 * glm::dot(at - last, at - last));
            last_force = force;
            const double depth = tool == 2 ? depth_of_burr(pose) : depth_of_blade(shape, pose);
            if (approaches && depth > 0.5e-3) {
                CAPTURE(tool, n, share, depth * 1e3, magnitudes);
                REQUIRE(magnitudes > 0.0);
                ++pressed;
            }
        };
        // The last 12 mm in steps of 0.1 mm; straight out again.
        go(1.0, true);
        for (double share = 0.98; share > 0.17; share -= 0.03) go(share, true);
        for (int k = 0; k <= 120; ++k) go(0.17 * (1.0 - k / 120.0), true);
        for (int k = 0; k <= 120; ++k) go(0.17 * k / 120.0, false);
        for (double share = 0.18; share < 1.0; share += 0.03) go(share, false);
        // Balls that slid round the block hold the hand back from behind, until it has been outside for 2 s.
        for (int k = 0; k < 2200 && last_force != Vec3(0.0); ++k) go(1.0, false);
        CAPTURE(tool, n, work, bound);
        CHECK(work <= 1.1 * bound + 1e-9);
        CHECK(last_force == Vec3(0.0));
    }
    CHECK(pressed > 1000);
}

TEST_CASE("the force of a blade that lies on bone is continuous in its turn about its length") {
    const auto bone = bone_block({.low = {-0.025, -0.012, -0.008}, .high = {0.025, 0.012, 0.0}, .voxel = 0.5e-3});
    const auto force_at = [&](double degrees) {
        saw::SawBlade blade({}, 20e3);
        const double a = degrees * std::numbers::pi / 180.0;
        const Quat turn = glm::angleAxis(a, Vec3(1.0, 0.0, 0.0)) * teeth_down;
        // The lowest edge, of the teeth or of the back, 1 mm below the surface.
        const double low = std::min(0.0, 0.010 * std::cos(a)) - 0.35e-3 * std::abs(std::sin(a));
        double force = 0.0;
        for (int n = 0; n <= 300; ++n) {
            const double z = 0.005 - low - 0.006 * n / 300.0;
            force = blade.step(bone->current(), {Vec3(0.0, 0.0, z), turn}, {false, 0.0, 1e-3}, {}).wrench.force.z;
        }
        return force;
    };
    for (int degrees = 0; degrees <= 180; degrees += 15) {
        const double force = force_at(degrees), beside = force_at(degrees + 0.05);
        CAPTURE(degrees, force, beside);
        CHECK(force > 0.5);
        CHECK(std::abs(beside - force) < 0.2);  // 0.05 degrees move an edge by 9 um
    }
}

TEST_CASE("the force of a blade in bone ends at zero when it is drawn out") {
    const auto bone = bone_block({.voxel = 0.4e-3});
    Sawing sawing(*bone);
    Pushing hand;
    hand.push(sawing, 6.0, 1.0);
    for (int n = 0; n < 200; ++n) sawing.step({hand.position + Vec3(0.0, 0.0, 0.02e-3 * n), teeth_down});
    const Vec3 out = hand.position + Vec3(0.0, 0.0, 0.02e-3 * 199);
    for (int n = 0; n < 100; ++n) {
        // At rest beside the bone, with the tremor of a hand.
        const saw::SawContact now =
            sawing.step({out + 1e-5 * Vec3(std::sin(0.1 * n), std::cos(0.13 * n), 0.0), teeth_down});
        REQUIRE(now.magnitudes == 0.0);
        REQUIRE(now.count == 0);
    }
}

TEST_CASE("a burr rests on a bone whose grid ends nearer to it than the burr is thick") {
    const auto bone =
        bone_block({.low = {-0.006, -0.006, -0.006}, .high = {0.006, 0.006, 0.0}, .voxel = 0.3e-3, .margin = 0.6e-3});
    saw::Burr burr({0.002, 8.0}, 20e3);
    double last = 0.0, step = 0.0;
    for (int n = 0; n <= 400; ++n) {
        const double z = 3e-3 - 0.01e-3 * n;
        const double force =
            burr.step(bone->current(), {Vec3(0.0, 0.0, z), teeth_down}, {false, 0.0, 1e-3}, {}).wrench.force.z;
        if (z < 1.9e-3) REQUIRE(force > 0.0);
        if (z > 2.1e-3) REQUIRE(force == 0.0);
        step = std::max(step, force - last);
        last = force;
    }
    CHECK(step < 2.0);
}

TEST_CASE("teeth that are pressed sideways through a thin plate stay on the side that they came from") {
    const auto bone = bone_block({.low = {-0.02, -0.02, -0.0015}, .high = {0.02, 0.02, 0.0}, .voxel = 0.5e-3});
    saw::SawShape shape;
    shape.length = 0.02;
    saw::SawBlade blade(shape, 1000.0);
    const saw::Drive still{false, 0.0, 1e-3};
    double last = 0.0;
    // The blade lies flat on the plate and goes down by 4 mm.
    for (int n = 0; n < 500; ++n) {
        const double z = 1e-3 - 1e-5 * n;
        const saw::SawContact now = blade.step(bone->current(), {{0.0, 0.0, z}, {1.0, 0.0, 0.0, 0.0}}, still, {});
        CAPTURE(z, last);
        REQUIRE(now.wrench.force.z > last - 0.02);
        last = now.wrench.force.z;
    }
    CHECK(last > 2.0);
}

// SPDX-License-Identifier: Apache-2.0
// A sagittal saw: its teeth stand on the arc that they swing along.
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::test;

namespace {

const saw::SawShape sagittal{.kind = saw::SawKind::sagittal,
                             .length = 0.020,
                             .height = 0.060,
                             .thickness = 0.0009,
                             .kerf = 0.0012,
                             .stroke = 0.004};

const BoneBox wide{.low = {-0.016, -0.003, -0.006}, .high = {0.016, 0.003, 0.0}, .voxel = 0.4e-3};

double feed_at(double thrust) {
    const auto bone = bone_block({.voxel = 0.33e-3});
    Sawing sawing(*bone, 1000.0, 20e3, sagittal);
    Pushing hand;
    hand.push(sawing, thrust, 1.5);
    const double z = hand.position.z;
    hand.push(sawing, thrust, 1.5);
    return (z - hand.position.z) / 1.5;
}

}  // namespace

TEST_CASE("the floor that a sagittal saw cuts is the arc of its swing") {
    const auto bone = bone_block(wide);
    Sawing sawing(*bone, 1000.0, 20e3, sagittal);
    sawing.law = saw::CuttingLaw{}.sharpened(50.0);  // the cut follows the blade
    for (int n = 0; n <= 4000; ++n) sawing.step({Vec3(0.0, 0.0, 0.5e-3 - 1e-6 * n), teeth_down});
    for (int n = 0; n <= 500; ++n) sawing.step({Vec3(0.0, 0.0, -3.5e-3), teeth_down});
    // The deepest bone that is gone, along the blade.
    const auto floor_at = [&](double x) {
        double z = 0.0;
        while (z > -0.0055 && sawing.read.value({x, 0.0, z}) > 0.0) z -= 0.01e-3;
        return z;
    };
    const double middle = floor_at(0.0);
    CHECK(middle == Approx(-3.5e-3).margin(0.15e-3));
    for (const double x : {-0.010, -0.006, 0.006, 0.010}) {
        const double arc = 0.060 - std::sqrt(0.060 * 0.060 - x * x);
        CAPTURE(x, arc, middle, floor_at(x));
        CHECK(floor_at(x) - middle == Approx(arc).margin(0.12e-3));
    }
}

TEST_CASE("the feed of a sagittal saw follows thrust") {
    double last = 0.0;
    for (const double thrust : {5.0, 9.0, 15.0, 24.0}) {
        const double feed = feed_at(thrust);
        CAPTURE(thrust, feed, last);
        CHECK(feed > 1.2 * last);
        last = feed;
    }
}

TEST_CASE("a sagittal saw gives no energy and does not pull on closed paths") {
    for (const bool running : {false, true})
        for (const Vec3& aside : {Vec3(0.0), Vec3(0.008, 0.0, 0.0), Vec3(0.0, 0.002, 0.0)}) {
            const auto bone = bone_block(wide);
            Sawing sawing(*bone, 1000.0, 20e3, sagittal);
            sawing.drive.running = running;
            const auto eased = [](double s, double a, double b) {
                const double u = std::clamp((s - a) / (b - a), 0.0, 1.0);
                return u * u * (3.0 - 2.0 * u);
            };
            double work = 0.0, bound = 0.0, pull = 0.0, most = 0.0;
            Vec3 last(0.0, 0.0, 0.002), last_force(0.0);
            for (int n = 0; n <= 1500; ++n) {
                const double s = n / 1500.0;
                const Vec3 at = Vec3(0.0, 0.0, 0.002 - 0.0035 * (eased(s, 0.0, 0.5) - eased(s, 0.85, 1.0))) +
                                aside * (eased(s, 0.5, 0.65) - eased(s, 0.7, 0.85));
                const Vec3 force = sawing.step({at, teeth_down}).wrench.force;
                work += glm::dot(last_force, at - last);
                bound += 0.5 * std::min(std::abs(glm::dot(force - last_force, at - last)),
                                        20e3 * glm::dot(at - last, at - last));
                pull = std::max(pull, -force.z);
                most = std::max(most, glm::length(force));
                last = at;
                last_force = force;
            }
            CAPTURE(running, aside.x, aside.y, work, bound, pull, most);
            CHECK(work <= 1.02 * bound + 1e-9);
            CHECK(pull <= 1e-9);
            CHECK(most > 1.0);
            CHECK(glm::length(last_force) == 0.0);
            CHECK((sawing.removed > 0.0) == running);
        }
}

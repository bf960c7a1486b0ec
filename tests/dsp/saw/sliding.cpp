// SPDX-License-Identifier: Apache-2.0
// A hand that slides the saw to and fro over a bone that is narrower than the blade.
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/line_amplitude.hpp"

#include <complex>
#include <numbers>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

struct Slid {
    double feed = 0.0;  ///< m/s
    double removed = 0.0;  ///< m³
    std::vector<double> thrust;  ///< N
};

/// Pushes with `thrust` N for 4 s and slides by ±`reach` m once a second; results of the last 3 s.
Slid slide(double thrust, double reach, double voxel = 0.33e-3) {
    const auto bone = bone_block({.low = {-0.006, -0.004, -0.012}, .high = {0.006, 0.004, 0.0}, .voxel = voxel});
    Sawing sawing(*bone);
    Slid slid;
    double z = 0.3e-3, from = 0.0, before = 0.0;
    for (int n = 0; n < 4000; ++n) {
        const double x = reach * std::sin(2.0 * std::numbers::pi * n / 1000.0);
        const double force = sawing.step({Vec3(x, 0.0, z), teeth_down}).wrench.force.z;
        z -= (thrust - force) / 300.0 / sawing.rate;
        if (n == 1000) {
            from = z;
            before = sawing.removed;
        }
        if (n >= 1000) slid.thrust.push_back(force);
    }
    slid.feed = (from - z) / 3.0;
    slid.removed = sawing.removed - before;
    return slid;
}

}  // namespace

TEST_CASE("a hand that slides the saw over a narrow bone cuts about as fast as one that holds still", "[slow]") {
    for (const double thrust : {10.0, 20.0}) {
        const Slid still = slide(thrust, 0.0);
        for (const double reach : {0.002, 0.008}) {
            const Slid slid = slide(thrust, reach);
            CAPTURE(thrust, reach, still.feed * 1e3, slid.feed * 1e3, still.removed * 1e9, slid.removed * 1e9);
            CHECK(slid.feed > 0.7 * still.feed);
            CHECK(slid.feed < 1.4 * still.feed);
        }
    }
}

TEST_CASE("the force of a saw that slides does not show when the bone has a new version", "[slow]") {
    for (const double thrust : {7.5, 20.0})
        for (const double reach : {0.002, 0.008}) {
            const Slid slid = slide(thrust, reach);
            double floor = 0.0;
            for (const double hz : {50.0, 52.0, 54.0, 56.0, 64.0, 66.0, 68.0, 70.0})
                floor += test::line_amplitude(slid.thrust, hz) / 8.0;
            CAPTURE(thrust, reach, floor, test::line_amplitude(slid.thrust, 60.0),
                    test::line_amplitude(slid.thrust, 120.0));
            CHECK(test::line_amplitude(slid.thrust, 60.0) < floor + 0.01);
            CHECK(test::line_amplitude(slid.thrust, 120.0) < floor + 0.01);
        }
}

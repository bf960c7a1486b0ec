// SPDX-License-Identifier: Apache-2.0
#include "dsp/training/spared.hpp"
#include "dsp/core/constants.hpp"
#include "tests/dsp/training/block.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

/// A nerve of 3 mm diameter along y, 5 mm below the origin.
training::SparedStructure nerve(double h = 0.3 * mm) {
    return {"nerve", 1 * mm,
            test::grid_of({-12 * mm, -15 * mm, -17 * mm}, {12 * mm, 15 * mm, 7 * mm}, h,
                          [](const Vec3& p) { return std::hypot(p.x, p.z + 5 * mm) - 1.5 * mm; })};
}

/// A blade whose teeth look down (y of the blade is -z), at that height.
Pose blade_at(double z) {
    return {{0.0, 0.0, z}, glm::quat_cast(Mat3(Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, -1.0), Vec3(0.0, 1.0, 0.0)))};
}

}  // namespace

TEST_CASE("the clearance of a blade is its distance from the structure") {
    const training::SparedStructure structure = nerve();
    const training::BladeSize blade;
    for (const double z : {6 * mm, 2 * mm, 0.0, -2 * mm, -3 * mm}) {
        // From the tooth edge, which crosses above the nerve, less half a kerf (the blade is thickened on all sides).
        CHECK(std::abs(training::clearance_of(structure, blade, blade_at(z)) - (z + 3.5 * mm - 0.5 * mm)) < 0.1 * mm);
    }
    CHECK(training::clearance_of(structure, blade, blade_at(-5 * mm)) < -1.8 * mm);
    // Beside the nerve: the end of a reciprocating blade is nearer by half a stroke.
    Pose beside = blade_at(-6 * mm);
    beside.position.x = 30 * mm;
    CHECK(std::abs(training::clearance_of(structure, blade, beside) - (30 - 21.5 - 1.5 - 0.5) * mm) < 0.1 * mm);
}

TEST_CASE("the clearance is real-time safe and finite for any pose") {
    const training::SparedStructure structure = nerve();
    double sum = 0.0;
    const RealtimeViolations seen = watch([&] {
        for (int n = 0; n < 20; ++n) {
            const double c = training::clearance_of(structure, {}, blade_at((n - 10) * mm));
            sum += std::isfinite(c) ? 0.0 : 1.0;
        }
    });
    CHECK(seen.describe() == "none");
    CHECK(sum == 0.0);
}

TEST_CASE("a blade that goes through a nerve injures what lay in its kerf") {
    const training::SparedStructure structure = nerve(0.2 * mm);
    training::BladeSize blade;
    blade.kerf = 2 * mm;
    training::Injury injury(structure, blade);
    for (double z = 10 * mm; z > -9 * mm; z -= 0.3 * mm) injury.move_to(blade_at(z));
    const double section = std::numbers::pi * 1.5 * mm * 1.5 * mm;
    CHECK(std::abs(injury.injured_m3() - section * 2 * mm) < 0.12 * section * 2 * mm);
    CHECK(injury.closest() < 0.0);
}

TEST_CASE("fast and slow movements injure the same, and one that stops above injures nothing") {
    const training::SparedStructure structure = nerve();
    const training::BladeSize blade;
    training::Injury slow(structure, blade), fast(structure, blade), above(structure, blade);
    for (int n = 0; n <= 2000; ++n) slow.move_to(blade_at(10 * mm - 1e-5 * n));
    fast.move_to(blade_at(10 * mm));
    fast.move_to(blade_at(-10 * mm));
    CHECK(slow.injured_m3() > 1e-9);
    CHECK(std::abs(fast.injured_m3() - slow.injured_m3()) < 0.05 * slow.injured_m3());
    for (int n = 0; n <= 1000; ++n) above.move_to(blade_at(10 * mm - 1e-5 * n));
    CHECK(above.injured_m3() == 0.0);
    CHECK(std::abs(above.closest() - 3.0 * mm) < 0.1 * mm);
}

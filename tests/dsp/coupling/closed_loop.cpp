// SPDX-License-Identifier: Apache-2.0
// A hand without will on a device, sampled at 1 kHz, against the coupling: how stiff it may be before it rings.
#include "dsp/core/constants.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/dsp/coupling/held.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

constexpr double period = 1e-3;

/// A device of 0.1 kg and damping `damping` (N s/m) is pressed with 3 N on a table through a coupling of `stiffness` whose
/// force comes `late` ticks after the pose that it was computed from, and is given a knock. How far it swings after four
/// seconds as a share of how far it swings at first.
double swing_left(double stiffness, double damping, int late) {
    constexpr double mass = 0.1, press = 3.0;
    static const contact::Voxmap table = test::map_of(contact::Box{{20.0 * mm, 20.0 * mm, 6.0 * mm}}, 0.5 * mm);
    static const contact::Pointshell foot = contact::make_pointshell(bodies::foot_points(6, 8.0 * mm));
    test::Held held(foot, {&table});
    held.law.stiffness = 100e3;
    coupling::QuasiStaticCoupling coupling = test::coupling_for(held, {{0.0, 0.0, 3.0 * mm}, {1, 0, 0, 0}});
    coupling.settings.springs.linear.stiffness = stiffness;
    double z = 3.0 * mm - press / stiffness, v = 2.0 * mm, felt[3] = {press, press, press};
    const double decay = std::exp(-damping / mass * period);
    double first[2] = {1.0, -1.0}, last[2] = {1.0, -1.0};
    for (int n = 0; n < 4000; ++n) {
        for (int l = 2; l > 0; --l) felt[l] = felt[l - 1];
        felt[0] = coupling.update({{0.0, 0.0, z}, {1, 0, 0, 0}}, held).wrench.force.z;
        // Exactly what mass and damping do under a force that is constant for a tick.
        const double terminal = (felt[late] - press) / damping;
        z += terminal * period + (v - terminal) * mass / damping * (1.0 - decay);
        v = terminal + (v - terminal) * decay;
        double* range = n < 200 ? first : last;
        if (n < 200 || n >= 3800) range[0] = std::min(range[0], z), range[1] = std::max(range[1], z);
    }
    return (last[1] - last[0]) / (first[1] - first[0]);
}

}  // namespace

TEST_CASE("a device rests at 0.7 of the stiffness that theory allows and rings at 1.3 of it, with and without delay") {
    for (const double damping : {1.0, 2.0})
        for (const int late : {0, 1, 2}) {
            const double limit = damping / (period * (0.5 + late));
            CAPTURE(damping, late, limit);
            CHECK(swing_left(0.7 * limit, damping, late) < 0.1);
            CHECK(swing_left(1.3 * limit, damping, late) > 1.0);
        }
}

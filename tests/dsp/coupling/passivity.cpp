// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/passivity.hpp"

#include "dsp/core/quantile.hpp"
#include "dsp/coupling/force_shape.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace tactus;

namespace {

/// A mass of 0.1 kg falls on a sampled wall of `stiffness`; returns the observer's least energy and the last speed.
std::pair<double, double> on_a_wall(double stiffness, bool control) {
    coupling::PassivityObserver observer;
    double z = 1e-3, v = 0.0, least = 0.0, peak = 0.0;
    Wrench force;
    for (int n = 0; n < 3000; ++n) {
        for (int sub = 0; sub < 10; ++sub) {
            v += (force.force.z - 2.0 - 0.5 * v) / 0.1 * 1e-4;
            z += v * 1e-4;
        }
        const Wrench wall{{0.0, 0.0, z < 0.0 ? -stiffness * z : 0.0}, {}};
        const auto now = observer(wall, {{0.0, 0.0, z}, {1, 0, 0, 0}}, 1e-3, control, {.damping = 100.0});
        force = now.wrench;
        least = std::min(least, now.energy);
        if (n > 2500) peak = std::max(peak, std::abs(v));
    }
    return {least, peak};
}

struct Swing {
    double ratio = 0.0;  ///< of the largest kinetic energy to that at the start
    double least = 0.0;  ///< J, of the observer
};

/// A handle of 4e-4 kg·m² that turns at 10 rad/s into a torsion spring whose torque comes `delay` ticks late.
Swing on_a_late_spring(double stiffness, int delay, bool control, double max_damping = 0.02) {
    coupling::PassivityObserver observer;
    constexpr double inertia = 4e-4, start = 10.0;
    double angle = 0.0, w = start;
    std::vector<double> seen(static_cast<std::size_t>(delay) + 1, 0.0);
    Wrench torque;
    Swing swing;
    for (int n = 0; n < 3000; ++n) {
        for (int sub = 0; sub < 10; ++sub) {
            w += torque.torque.y / inertia * 1e-4;
            angle += w * 1e-4;
        }
        std::shift_right(seen.begin(), seen.end(), 1);
        seen[0] = angle;
        const Wrench spring{{}, {0.0, -stiffness * seen.back(), 0.0}};
        const Pose hand{{}, rotation_by({0.0, angle, 0.0})};
        const auto now = observer(spring, hand, 1e-3, control, {.angular_damping = max_damping});
        torque = now.wrench;
        swing.least = std::min(swing.least, now.energy);
        swing.ratio = std::max(swing.ratio, w * w / (start * start));
    }
    return swing;
}

}  // namespace

TEST_CASE("a wall too stiff for its device gives energy away, and the controller keeps it to a hundredth of that") {
    const auto [free, free_speed] = on_a_wall(3000.0, false);
    const auto [braked, braked_speed] = on_a_wall(3000.0, true);
    CHECK(free < -1e-3);
    CHECK(braked > 0.01 * free);
    CHECK(braked_speed < 0.1 * free_speed);
    // A soft spring with friction around it stays passive but for what sampling gives away in each bounce.
    CHECK(on_a_wall(100.0, false).first > -1e-3);
}

TEST_CASE("a torsion spring that comes late gains energy without bound, and none behind the controller") {
    for (const int delay : {1, 3}) {
        const Swing free = on_a_late_spring(3.0, delay, false);
        CHECK(free.ratio > 1e4);
        for (const double max_damping : {0.0, 0.02, 0.1}) {
            INFO(delay << " ticks, " << max_damping << " N m s/rad");
            const Swing braked = on_a_late_spring(3.0, delay, true, max_damping);
            CHECK(braked.ratio < 1.05);
            CHECK(braked.least > -1e-3);
        }
    }
}

TEST_CASE("a soft limit passes small forces, never exceeds its end and has no corner") {
    CHECK(coupling::soft_limit(3.0, 6.0, 10.0) == 3.0);
    CHECK(coupling::soft_limit(1e6, 6.0, 10.0) <= 10.0);
    CHECK(coupling::soft_limit(12.0, 6.0, 6.0) == 6.0);
    // A limit below the straight part counts.
    CHECK(coupling::soft_limit(5.0, 10.0, 6.0) == 5.0);
    CHECK(coupling::soft_limit(8.0, 10.0, 6.0) == 6.0);
    const double h = 1e-6;
    CHECK((coupling::soft_limit(6.0 + h, 6.0, 10.0) - 6.0) / h == Approx(1.0).epsilon(1e-3));
    const Vec3 v = coupling::soft_limit(Vec3(30.0, 40.0, 0.0), 6.0, 10.0);
    CHECK(v.y / v.x == Approx(4.0 / 3.0));
}

TEST_CASE("quantiles of counted sizes are within a class of the true ones") {
    SizeCounts counts;
    CHECK(counts.quantile(0.99) == 0.0);
    for (int n = 1; n <= 1000; ++n) counts.add(1e-4 * n);
    CHECK(counts.quantile(0.5) == Approx(0.05).epsilon(0.04));
    CHECK(counts.quantile(0.99) == Approx(0.099).epsilon(0.04));
    CHECK(counts.quantile(1.0) == Approx(0.1));
}

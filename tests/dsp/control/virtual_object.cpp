// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/virtual_object.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace tactus;

namespace {

constexpr double dt = 1.0 / 150.0;

control::VirtualObject make(const control::ObjectSettings& settings, double at = 0.0) {
    control::VirtualObject object;
    object.set(settings, dt);
    object.place(at);
    return object;
}

/// Explicit steps a thousand times finer: another way to the same motion.
double fine(control::ObjectSettings o, double x, double v, double force, double seconds) {
    const double h = 1e-7;
    for (double t = 0.0; t < seconds - 0.5 * h; t += h) {
        const bool free = o.one_sided && x < o.rest;
        const double k = free ? 0.0 : o.stiffness, b = free ? o.free_damping : o.damping;
        if (o.mass > 0.0) {
            v += h * (force - k * (x - o.rest) - b * v) / o.mass;
            x += h * v;
        } else {
            x += h * (force - k * (x - o.rest)) / b;
        }
    }
    return x;
}

}  // namespace

TEST_CASE("a spring stands at F/k at once, a damper runs at F/b, both together approach as e^(-kt/b)") {
    CHECK(make({.stiffness = 500.0}).step(2.0) == Approx(0.004).epsilon(1e-14));
    control::VirtualObject damper = make({.stiffness = 0.0, .damping = 20.0});
    for (int n = 1; n <= 30; ++n) CHECK(damper.step(1.5) == Approx(1.5 / 20.0 * n * dt).epsilon(1e-12));
    control::VirtualObject both = make({.stiffness = 1000.0, .damping = 50.0});
    for (int n = 1; n <= 60; ++n)
        CHECK(both.step(3.0) == Approx(3e-3 * (1.0 - std::exp(-1000.0 / 50.0 * n * dt))).epsilon(1e-12));
}

TEST_CASE("a mass on a spring swings as the closed form says, under-, over- and undamped") {
    const double k = 200.0, m = 0.5, w = std::sqrt(k / m);
    control::VirtualObject undamped = make({.stiffness = k, .mass = m});
    for (int n = 1; n <= 300; ++n)
        CHECK(undamped.step(1.0) == Approx(1.0 / k * (1.0 - std::cos(w * n * dt))).margin(1e-13));
    const double zeta = 0.3, wd = w * std::sqrt(1.0 - zeta * zeta);
    control::VirtualObject damped = make({.stiffness = k, .damping = 2.0 * zeta * std::sqrt(k * m), .mass = m});
    for (int n = 1; n <= 300; ++n) {
        const double t = n * dt;
        const double swing = std::cos(wd * t) + zeta / std::sqrt(1.0 - zeta * zeta) * std::sin(wd * t);
        CHECK(damped.step(1.0) == Approx(1.0 / k * (1.0 - std::exp(-zeta * w * t) * swing)).margin(1e-13));
    }
    const double s1 = -4.0, s2 = -100.0;  // poles of m s² + b s + k with b, k from them
    control::VirtualObject slow = make({.stiffness = m * s1 * s2, .damping = -m * (s1 + s2), .mass = m});
    for (int n = 1; n <= 300; ++n) {
        const double t = n * dt, share = 1.0 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2);
        CHECK(slow.step(1.0) == Approx(share / (m * s1 * s2)).margin(1e-13));
    }
    control::VirtualObject mass = make({.stiffness = 0.0, .mass = 2.0});
    for (int n = 1; n <= 100; ++n) CHECK(mass.step(1.0) == Approx(0.25 * std::pow(n * dt, 2)).epsilon(1e-11));
}

TEST_CASE("a two-sided wall never moves, a one-sided one stops the finger and lets it go") {
    control::VirtualObject rigid = make({.kind = control::ObjectKind::wall, .rest = 0.01}, 0.01);
    for (const double f : {-9.5, 9.5, 1e6}) CHECK(rigid.step(f) == 0.01);
    control::VirtualObject wall =
        make({.kind = control::ObjectKind::wall, .one_sided = true, .rest = 0.01, .free_damping = 20.0}, 0.0);
    double x = 0.0;
    while (x < 0.01) {
        const double next = wall.step(2.0);
        CHECK(next == Approx(std::min(0.01, x + 0.1 * dt)).epsilon(1e-12));
        REQUIRE(next > x);
        x = next;
    }
    CHECK(wall.step(100.0) == 0.01);
    CHECK(wall.step(-2.0) == Approx(0.01 - 0.1 * dt).epsilon(1e-12));
}

TEST_CASE("a one-sided object is met and left within a period, exactly") {
    const control::ObjectSettings settings{
        .stiffness = 1000.0, .damping = 30.0, .one_sided = true, .rest = 0.005, .free_damping = 10.0};
    for (const double start : {0.0045, 0.005, 0.0052, 0.0060})
        for (const double force : {-4.0, -0.2, 0.3, 4.0}) {
            CAPTURE(start, force);
            CHECK(make(settings, start).step(force) == Approx(fine(settings, start, 0.0, force, dt)).margin(2e-9));
        }
    const control::ObjectSettings spring{.stiffness = 1000.0, .one_sided = true, .rest = 0.0, .free_damping = 10.0};
    CHECK(make(spring, 0.002).step(1.0) == Approx(0.001));
    CHECK(make(spring, 0.002).step(-1.0) == Approx(-1.0 * dt / 10.0));
}

TEST_CASE("a table is followed in, stands still, and is followed out: the loop encloses what the object keeps") {
    const control::DeflectionTable foam{{-1.0, 0.0, 1.0, 3.0}, {-1e-3, 0.0, 2e-3, 4e-3}, {-0.5e-3, 1e-3, 3e-3, 4e-3}};
    REQUIRE(foam.fault().empty());
    CHECK(foam.min_stiffness() == Approx(1.0 / 2e-3));
    control::VirtualObject object = make({.kind = control::ObjectKind::table, .table = &foam});
    CHECK(object.step(0.5) == Approx(1e-3));
    CHECK(object.step(3.0) == Approx(4e-3));
    CHECK(object.step(2.5) == Approx(3.75e-3));  // leaves the loading curve where the other one is met
    CHECK(object.step(1.0) == Approx(3e-3));
    CHECK(object.step(1.5) == Approx(3e-3));     // turned round inside the loop
    CHECK(object.step(3.0) == Approx(4e-3));
    CHECK(object.step(4.0) == Approx(5e-3));     // beyond the table, as stiff as its end
    double work = 0.0, before = object.step(0.0);
    for (int n = 0; n <= 4000; ++n) {
        const double f = 1.5 - 1.5 * std::cos(n * 2.0 * 3.14159265358979 / 2000.0), x = object.step(f);
        if (n >= 2000) work += f * (x - before);
        before = x;
    }
    // Between the curves from 0 to 3 N lie 2 mJ, less the corner that a rise from 1 mm cuts off.
    CHECK(work == Approx(1.75e-3).epsilon(0.01));
}

TEST_CASE("tables that are no objects are named as such") {
    CHECK(control::DeflectionTable{{1.0}, {0.0}, {0.0}}.fault().find("two rows") != std::string::npos);
    CHECK(control::DeflectionTable{{1.0, 1.0}, {0, 0}, {0, 0}}.fault().find("row 2") != std::string::npos);
    CHECK(control::DeflectionTable{{0.0, 1.0}, {1, 0}, {1, 1}}.fault().find("must not fall") != std::string::npos);
    CHECK(control::DeflectionTable{{0.0, 1.0}, {1, 2}, {0, 2}}.fault().find("let go") != std::string::npos);
    CHECK(control::DeflectionTable{{0.0, NAN}, {0, 1}, {0, 1}}.fault().find("not finite") != std::string::npos);
}

TEST_CASE("a new object begins where the old one was, and an object of nothing cannot be rendered") {
    control::VirtualObject object = make({.stiffness = 100.0, .damping = 10.0});
    for (int n = 0; n < 10; ++n) object.step(1.0);
    const double before = object.position();
    object.set({.stiffness = 5000.0, .damping = 10.0, .rest = 0.003}, dt);
    CHECK(object.position() == Approx(before).epsilon(1e-15));
    CHECK_FALSE(control::ObjectSettings{.stiffness = 0.0}.is_renderable());
    CHECK_FALSE(control::ObjectSettings{.kind = control::ObjectKind::table}.is_renderable());
    CHECK_FALSE(control::ObjectSettings{.one_sided = true, .free_damping = 0.0}.is_renderable());
    CHECK(control::ObjectSettings{.stiffness = 0.0, .mass = 1.0}.is_renderable());
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/late_return.hpp"

#include "dsp/control/energy_cap.hpp"
#include "dsp/control/force_limiter.hpp"
#include "tests/dsp/control/period.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

/// Forces that are lost at once to a late tick; the hand is given nothing until they come back.
struct Waiting {
    control::LateReturn late;

    Waiting() { late.prepare(period, 1.0); }
    void lose() {
        late.tick(true, false, period);
        late.lose();
    }
    /// Ticks until forces may come back; `most` of them when they may not.
    int ticks_until_return(int most = 5000, bool is_quiet = true) {
        for (int n = 1; n <= most; ++n) {
            late.tick(false, is_quiet, period);
            if (late.returns()) return n;
        }
        return most;
    }
};

/// A hand of a person that is held by muscles at a depth inside of a wall: mass, spring and damper.
struct HeldHand {
    double mass = 0.3, muscle = 300.0, damping = 4.0;  ///< kg, N/m, N·s/m
    double target = 5e-3;                              ///< m inside
    double x = 5e-3, v = 0.0;

    /// One period under a held force.
    void live(double force) {
        constexpr int steps = 10;
        for (int i = 0; i < steps; ++i) {
            const double h = period / steps;
            v += (force + muscle * (target - x) - damping * v) / mass * h;
            x += v * h;
        }
    }
};

struct Return {
    double given_J = 0.0;  ///< most that the wall has given the hand, less what the hand has damped, until it pushes
    double fastest = 0.0;  ///< m/s outwards, until it pushes
    double motion_J = 0.0;  ///< most kinetic energy outwards, until it pushes
    double force_N = 0.0;  ///< largest while it pushes
};

/// The forces of a wall of that stiffness come back to a hand that is inside; two seconds later it pushes in by 3 mm more, in
/// half a second.
Return come_back(HeldHand hand, double stiffness, bool is_capped, double ramp_s = control::LateReturn::ramp_s) {
    control::ForceLimiter limiter;
    limiter.prepare({.engage_ramp_s = 1e-3}, period);
    control::EnergyCap cap;
    cap.prepare({});
    Return result;
    Wrench committed;
    double work = 0.0, damped = 0.0;
    std::int64_t count = 0;
    limiter.cut(control::Fault::late_commit);
    for (int n = 0; n < 4000; ++n) {
        if (n == 1000) limiter.recover_slowly(ramp_s);
        if (n >= 3000 && n < 3500) hand.target += 3e-3 / 500.0;
        const double seen = std::round(hand.x / 20e-6) * 20e-6;
        limiter.start_from(committed);
        Wrench out = limiter.tick({{seen > 0.0 ? -stiffness * seen : 0.0, 0.0, 0.0}, {}}, ++count, true, period);
        if (is_capped) out = cap.tick(out, committed, {{seen, 0.0, 0.0}, {1, 0, 0, 0}}, period, 0.0, false);
        committed = out;
        const double before = hand.x;
        hand.live(out.force.x);
        if (n >= 3000) result.force_N = std::max(result.force_N, -out.force.x);
        else {
            work += out.force.x * (hand.x - before);
            damped += hand.damping * hand.v * hand.v * period;
            result.given_J = std::max(result.given_J, work - damped);
            result.fastest = std::max(result.fastest, -hand.v);
            if (hand.v < 0.0) result.motion_J = std::max(result.motion_J, 0.5 * hand.mass * hand.v * hand.v);
        }
        if (n < 1000) REQUIRE(out.force.x == 0.0);
        // Not before its time: a share of the ramp and no more.
        if (ramp_s == control::LateReturn::ramp_s && n >= 1000 && n < 1500)
            REQUIRE(std::abs(out.force.x) <= 10.0 * (n - 999) / 500.0 + 1e-9);
    }
    return result;
}

}  // namespace

TEST_CASE("after a late tick forces come back when ticks were on time for a second") {
    Waiting waiting;
    waiting.lose();
    CHECK(waiting.ticks_until_return() == 1000);
    SECTION("a late tick begins the second anew") {
        waiting.lose();
        CHECK(waiting.ticks_until_return(700) == 700);
        waiting.late.tick(true, true, period);
        CHECK(waiting.ticks_until_return() == 1000);
    }
    SECTION("so do three ticks that are left out at once") {
        waiting.lose();
        CHECK(waiting.ticks_until_return(700) == 700);
        waiting.late.tick(false, true, 4.0 * period);
        CHECK(waiting.ticks_until_return() == 1000);
    }
    SECTION("ten that are left out one by one do not") {
        waiting.lose();
        for (int n = 0; n < 10; ++n) {
            waiting.late.tick(false, true, 2.0 * period);
            CHECK(waiting.ticks_until_return(48) == 48);
        }
        CHECK(waiting.ticks_until_return() == 500);
    }
    SECTION("eleven do") {
        waiting.lose();
        for (int n = 0; n < 11; ++n) {
            waiting.late.tick(false, true, 2.0 * period);
            CHECK(waiting.ticks_until_return(48) == 48);
        }
        CHECK(waiting.ticks_until_return() == 952);
    }
    SECTION("a wait of ten seconds ends although two ticks are left out each second") {
        waiting.late.prepare(period, 10.0);
        waiting.lose();
        int ticks = 0;
        for (bool is_back = false; !is_back && ticks < 60'000; ++ticks) {
            waiting.late.tick(false, true, ticks % 500 == 250 ? 2.0 * period : period);
            is_back = waiting.late.returns();
        }
        CHECK(ticks == 9980);  // 20 of 10 000 were left out
    }
    SECTION("eleven that are left out within a second begin a longer wait anew as well") {
        waiting.late.prepare(period, 10.0);
        waiting.lose();
        CHECK(waiting.ticks_until_return(9000) == 9000);
        for (int n = 0; n < 11; ++n) waiting.late.tick(false, true, 2.0 * period);
        CHECK(waiting.ticks_until_return(20'000) == 10'000);
    }
    SECTION("a longer wait that the patch asks for is kept") {
        waiting.late.prepare(period, 3.0);
        waiting.lose();
        CHECK(waiting.ticks_until_return() == 3000);
    }
    SECTION("a shorter one is not") {
        waiting.late.prepare(period, 0.1);
        waiting.lose();
        CHECK(waiting.ticks_until_return() == 1000);
    }
}

TEST_CASE("forces do not come back before the hand was given none for half a second") {
    Waiting waiting;
    waiting.lose();
    CHECK(waiting.ticks_until_return(1200, false) == 1200);
    CHECK(waiting.ticks_until_return() == 500);
}

TEST_CASE("forces come back three times a minute, then by hand") {
    Waiting waiting;
    for (int n = 0; n < 3; ++n) {
        waiting.lose();
        CHECK_FALSE(waiting.late.needs_hand());
        CHECK(waiting.ticks_until_return() == 1000);
    }
    waiting.lose();
    CHECK(waiting.late.needs_hand());
    // However long one waits.
    CHECK(waiting.ticks_until_return(70'000) == 70'000);
    CHECK(waiting.late.needs_hand());
    waiting.late.forgive();
    CHECK(waiting.ticks_until_return() == 1);

    Waiting patient;
    for (int n = 0; n < 6; ++n) {
        patient.lose();
        CHECK_FALSE(patient.late.needs_hand());
        CHECK(patient.ticks_until_return() == 1000);
        for (int k = 0; k < 20'000; ++k) patient.late.tick(false, false, period);
    }
}

TEST_CASE("who lets forces return and goes away is not given a force") {
    Waiting waiting;
    for (int n = 0; n < 3; ++n) {
        waiting.lose();
        REQUIRE(waiting.ticks_until_return() == 1000);
    }
    waiting.lose();
    REQUIRE(waiting.late.needs_hand());
    waiting.late.forgive();
    // Forces may come back a second later at the earliest, and the press holds for ten seconds more.
    const auto be_late_for = [&](int ticks) {
        for (int n = 0; n < ticks; ++n) waiting.lose();
    };
    SECTION("in time they come back") {
        be_late_for(9'900);
        CHECK(waiting.ticks_until_return() == 1000);
        CHECK_FALSE(waiting.late.is_attended());
    }
    SECTION("later they need a person again") {
        be_late_for(10'100);
        CHECK(waiting.ticks_until_return() == 5000);
        CHECK(waiting.late.needs_hand());
        waiting.late.forgive();
        CHECK(waiting.ticks_until_return() == 1);
    }
    SECTION("a second press counts anew") {
        be_late_for(9'000);
        waiting.late.forgive();
        be_late_for(9'900);
        CHECK(waiting.ticks_until_return() == 1000);
    }
    SECTION("no press makes forces that come back by themselves need a person") {
        waiting.late.forgive();
        REQUIRE(waiting.ticks_until_return(1000) == 1000);
        waiting.lose();
        waiting.late.forgive();
        be_late_for(12'000);
        CHECK_FALSE(waiting.late.needs_hand());
        CHECK(waiting.ticks_until_return() == 1000);
    }
}

TEST_CASE("a return counts from when the hand may feel forces") {
    Waiting waiting;
    waiting.lose();
    CHECK(waiting.late.is_lost());
    CHECK(waiting.ticks_until_return() == 1000);
    CHECK_FALSE(waiting.late.is_lost());
    // The hand leaves the body 50 s later.
    for (int n = 0; n < 50'000; ++n) {
        waiting.late.tick(false, true, period);
        waiting.late.come_in(false, false);
    }
    REQUIRE(waiting.late.comes_in());
    waiting.late.come_in(true, false);
    REQUIRE(waiting.late.comes_in());
    waiting.late.come_in(true, true);
    CHECK_FALSE(waiting.late.comes_in());
    for (int n = 0; n < 2; ++n) {
        waiting.lose();
        CHECK(waiting.ticks_until_return() == 1000);
    }
    for (int n = 0; n < 20'000; ++n) waiting.late.tick(false, false, period);
    waiting.lose();
    CHECK(waiting.late.needs_hand());
}

TEST_CASE("a return that engages can have a longer ramp") {
    control::ForceLimiter limiter;
    limiter.prepare({.engage_ramp_s = 1e-3}, period);
    std::int64_t count = 0;
    const auto force = [&](double raw) { return limiter.tick({{0.0, 0.0, raw}, {}}, ++count, true, period).force.z; };
    limiter.cut(control::Fault::late_commit);
    limiter.recover(0.5);
    for (int n = 0; n < 3; ++n) REQUIRE(force(0.1) == 0.0);
    for (int n = 0; n < 249; ++n) REQUIRE(force(8.0) <= 4.0);
    CHECK(force(8.0) == Approx(4.0));
}

TEST_CASE("a slow return ramps a large force in over half a second of ticks on time") {
    control::ForceLimiter limiter;
    limiter.prepare({}, period);
    std::int64_t count = 0;
    const auto force = [&](double elapsed) {
        return limiter.tick({{0.0, 0.0, 8.0}, {}}, ++count, true, elapsed).force.z;
    };
    limiter.cut(control::Fault::late_commit);
    for (int n = 0; n < 1000; ++n) REQUIRE(force(period) == 0.0);
    limiter.recover_slowly(0.5);
    CHECK(limiter.engaged());
    CHECK(limiter.is_ramping());
    for (int n = 0; n < 250; ++n) force(period);
    CHECK(force(period) == Approx(4.0).epsilon(0.02));
    // Ticks that are left out do not shorten it.
    CHECK(force(0.2) == Approx(4.0).epsilon(0.02));
    for (int n = 0; n < 260; ++n) force(period);
    CHECK(force(period) == Approx(8.0));
    CHECK_FALSE(limiter.is_ramping());

    // A pause meanwhile: forces wait for the hand to leave, as ever.
    limiter.hold_off(true);
    force(period);
    limiter.hold_off(false);
    for (int n = 0; n < 500; ++n) force(period);
    CHECK(force(period) == 0.0);
    CHECK_FALSE(limiter.engaged());
}

TEST_CASE(
    "forces that come back to a hand deep inside of a wall do not throw it out, and it feels the wall when it pushes") {
    Return worst, bare;
    for (const double mass : {0.1, 0.3, 1.0})
        for (const double stiffness : {500.0, 1e3, 2e3, 5e3})
            for (const double muscle : {50.0, 300.0, 1000.0}) {
                const HeldHand hand{.mass = mass, .muscle = muscle};
                INFO(mass << " kg, wall " << stiffness << " N/m, muscles " << muscle << " N/m");
                const Return slow = come_back(hand, stiffness, true), jump = come_back(hand, stiffness, false, 1e-3);
                // It is not thrown out, and what it is given in half a second its muscles hold.
                CHECK(slow.motion_J <= 1e-3);
                CHECK(slow.fastest <= 0.1);
                CHECK(slow.given_J <= 12e-3);
                // Muscles that reach 3 mm further feel at least half of what they exert.
                CHECK(slow.force_N > 0.5 * muscle * 3e-3);
                worst.given_J = std::max(worst.given_J, slow.given_J);
                worst.fastest = std::max(worst.fastest, slow.fastest);
                worst.motion_J = std::max(worst.motion_J, slow.motion_J);
                bare.given_J = std::max(bare.given_J, jump.given_J);
                bare.fastest = std::max(bare.fastest, jump.fastest);
                bare.motion_J = std::max(bare.motion_J, jump.motion_J);
            }
    CAPTURE(worst.given_J, worst.fastest, worst.motion_J, bare.given_J, bare.fastest, bare.motion_J);
    // Forces that came back at once, without an energy cap, would throw it out.
    CHECK(bare.fastest > 5.0 * worst.fastest);
    CHECK(bare.motion_J > 20.0 * worst.motion_J);
    CHECK(bare.given_J > 5.0 * worst.given_J);
}

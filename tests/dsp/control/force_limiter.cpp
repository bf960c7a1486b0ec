// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/force_limiter.hpp"
#include "tests/dsp/control/period.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <limits>

using namespace tactus;

namespace {

/// A limiter with a driver that counts, and the largest output and output step seen so far.
struct Rig {
    control::ForceLimiter limiter;
    control::ForceLimits limits;
    std::int64_t counter = 0;
    Wrench out;
    double max_force = 0.0, max_torque = 0.0, max_step = 0.0, max_torque_step = 0.0;

    explicit Rig(control::ForceLimits given = {}) : limits(given) { limiter.prepare(limits, period); }

    void run(const Wrench& raw, int ticks, bool counting = true, bool valid = true) {
        for (int i = 0; i < ticks; ++i) {
            const Wrench now = limiter.tick(raw, counting ? ++counter : counter, valid, period);
            REQUIRE(is_finite(now));
            max_force = std::max(max_force, glm::length(now.force));
            max_torque = std::max(max_torque, glm::length(now.torque));
            max_step = std::max(max_step, glm::length(now.force - out.force));
            max_torque_step = std::max(max_torque_step, glm::length(now.torque - out.torque));
            out = now;
        }
    }
    void engage() { run({}, 200); }
    bool within_limits() const {
        constexpr double slack = 1.0 + 1e-9;
        return max_force <= limits.max_force * slack && max_torque <= limits.max_torque * slack &&
               max_step <= limits.force_slew * period * slack && max_torque_step <= limits.torque_slew * period * slack;
    }
};

const Wrench push{{0.0, 0.0, 8.0}, {0.0, 0.3, 0.0}};

}  // namespace

TEST_CASE("a force within the limits passes unchanged once engaged") {
    Rig rig;
    rig.engage();
    rig.run(push, 20);
    CHECK(rig.out.force.z == Approx(8.0));
    CHECK(rig.out.torque.y == Approx(0.3));
    CHECK(rig.limiter.statistics().force_limited == 0);
}

TEST_CASE("forces do not start while they are large, and then ramp in over 100 ms") {
    Rig rig;
    rig.run(push, 500);
    CHECK(rig.max_force == 0.0);
    CHECK_FALSE(rig.limiter.engaged());
    rig.run({}, rig.limits.engage_ticks);
    CHECK(rig.limiter.engaged());
    rig.run({{0.0, 0.0, 8.0}, {}}, 50);
    CHECK(rig.out.force.z == Approx(4.0).epsilon(0.05));
    rig.run({{0.0, 0.0, 8.0}, {}}, 60);
    CHECK(rig.out.force.z == Approx(8.0));
}

TEST_CASE("a spike of 1000 N stays within force and slew limits and keeps its direction") {
    Rig rig;
    rig.engage();
    rig.run({{600.0, 0.0, 800.0}, {0.0, 90.0, 0.0}}, 50);
    CHECK(rig.within_limits());
    CHECK(glm::length(rig.out.force) == Approx(rig.limits.max_force));
    CHECK(rig.out.force.x / rig.out.force.z == Approx(0.75));
    CHECK(rig.limiter.fault() == control::Fault::none);
    CHECK(rig.limiter.statistics().force_limited == 50);
    CHECK(rig.limiter.statistics().slew_limited == 1);
    CHECK(rig.limiter.statistics().max_force == Approx(1000.0));
    CHECK(rig.limiter.statistics().max_force_step == Approx(1000.0));
    CHECK(rig.limiter.statistics().max_torque == Approx(90.0));
    rig.run({{1e200, 1e200, 0.0}, {}}, 50);
    CHECK(rig.within_limits());
}

TEST_CASE("a force that flips by 180 degrees turns round at the slew limit") {
    Rig rig;
    rig.engage();
    rig.run(push, 50);
    rig.run(push * -1.0, 5);
    CHECK(rig.out.force.z == Approx(8.0 - 5 * rig.limits.force_slew * period));
    rig.run(push * -1.0, 50);
    CHECK(rig.out.force.z == Approx(-8.0));
    CHECK(rig.within_limits());
}

TEST_CASE("every fault fades to zero within 10 ms, says why, and latches until recovered") {
    Rig rig;
    rig.engage();
    rig.run(push, 50);
    control::Fault expected = control::Fault::none;
    SECTION("NaN force") {
        expected = control::Fault::not_finite;
        rig.run({{0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}, {}}, 1);
    }
    SECTION("infinite torque") {
        expected = control::Fault::not_finite;
        rig.run({{}, {std::numeric_limits<double>::infinity(), 0.0, 0.0}}, 1);
    }
    SECTION("the driver's counter stops") {
        expected = control::Fault::stale_input;
        rig.run(push, rig.limits.stale_ticks - 1, false);
        CHECK(rig.limiter.fault() == control::Fault::none);
        rig.run(push, 1, false);
    }
    SECTION("an invalid sample") {
        expected = control::Fault::invalid_input;
        rig.run(push, 1, true, false);
    }
    SECTION("a fault found by someone else") {
        expected = control::Fault::late_commit;
        rig.limiter.fail(control::Fault::late_commit);
        rig.run(push, 1);
    }
    CHECK(rig.limiter.fault() == expected);
    CHECK(rig.out.force.z > 0.0);
    rig.run(push, 9);
    CHECK(glm::length(rig.out.force) == 0.0);
    CHECK(glm::length(rig.out.torque) == 0.0);
    CHECK(rig.within_limits());

    rig.run({}, 100);
    rig.run(push, 100);
    CHECK(glm::length(rig.out.force) == 0.0);
    CHECK(rig.limiter.fault() == expected);

    rig.limiter.recover();
    rig.run(push, 100);
    CHECK(glm::length(rig.out.force) == 0.0);
    rig.engage();
    rig.run(push, 50);
    CHECK(rig.out.force.z == Approx(8.0));
    CHECK(rig.within_limits());
}

TEST_CASE("a fade takes 10 ms, however soon the fault is over and however slow the slew is") {
    control::ForceLimits limits;
    limits.force_slew = 10.0;  // N/s
    for (const int faulty_ticks : {1, 2, 5}) {
        Rig rig(limits);
        rig.engage();
        rig.run({{0.0, 0.0, 3.0}, {}}, 1000);
        REQUIRE(rig.out.force.z == Approx(3.0));
        rig.run({{0.0, 0.0, 3.0}, {}}, faulty_ticks, true, false);
        rig.limiter.recover();
        rig.run({{0.0, 0.0, 3.0}, {}}, 10 - faulty_ticks);
        CHECK(rig.out.force.z == Approx(0.0).margin(1e-9));
        rig.run({}, 200);
        rig.run({{0.0, 0.0, 3.0}, {}}, 1000);
        CHECK(rig.out.force.z == Approx(3.0));
    }
    // Also when the force is small meanwhile, so that it could engage.
    for (const int faulty_ticks : {1, 2, 5}) {
        Rig rig(limits);
        rig.engage();
        rig.run({{0.0, 0.0, 3.0}, {}}, 1000);
        rig.run({{0.0, 0.0, 3.0}, {}}, faulty_ticks, true, false);
        rig.limiter.recover();
        rig.run({}, 10 - faulty_ticks);
        CHECK(rig.out.force.z == Approx(0.0).margin(1e-9));
    }
    // Held off for a moment: the same.
    Rig rig(limits);
    rig.engage();
    rig.run({{0.0, 0.0, 3.0}, {}}, 1000);
    rig.limiter.hold_off(true);
    rig.run({{0.0, 0.0, 3.0}, {}}, 2);
    rig.limiter.hold_off(false);
    rig.run({{0.0, 0.0, 3.0}, {}}, 8);
    CHECK(rig.out.force.z == Approx(0.0).margin(1e-9));
}

TEST_CASE("a fault that names a cause replaces a late tick and no other fault: only what is not finite replaces all") {
    for (const control::Fault cause : {control::Fault::sound_lost, control::Fault::stale_input}) {
        Rig rig;
        rig.engage();
        rig.run(push, 20);
        rig.limiter.cut(control::Fault::late_commit);
        rig.run(push, 1);
        CHECK(rig.limiter.fault() == control::Fault::late_commit);
        rig.limiter.fail(cause);
        rig.run(push, 1);
        CHECK(rig.limiter.fault() == cause);
        CHECK(glm::length(rig.out.force) == 0.0);
        rig.limiter.fail(control::Fault::invalid_input);
        CHECK(rig.limiter.fault() == cause);
    }
    // A force that is not finite must not come in again by itself, whatever came before.
    Rig rig;
    rig.engage();
    rig.limiter.cut(control::Fault::late_commit);
    rig.run({{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {}}, 1);
    CHECK(rig.limiter.fault() == control::Fault::not_finite);
    for (const control::Fault passes : {control::Fault::invalid_input, control::Fault::sound_lost}) {
        Rig other;
        other.limiter.fail(passes);
        other.limiter.fail(control::Fault::not_finite);
        CHECK(other.limiter.fault() == control::Fault::not_finite);
        other.limiter.fail(passes);
        other.limiter.fail(control::Fault::none);
        CHECK(other.limiter.fault() == control::Fault::not_finite);
    }
}

TEST_CASE("a resting hand is not a stale device") {
    Rig rig;
    rig.engage();
    rig.run({{0.0, 0.0, 3.0}, {}}, 5000);
    CHECK(rig.limiter.fault() == control::Fault::none);
    CHECK(rig.out.force.z == Approx(3.0));
}

TEST_CASE("a fade goes on from what another thread committed, and never grows again") {
    Rig rig;
    rig.engage();
    rig.run(push, 50);
    rig.limiter.fail(control::Fault::late_commit);
    rig.run(push, 1);
    const Wrench committed = rig.out * 0.25;
    rig.limiter.start_from(committed);
    double last = glm::length(committed.force), last_torque = glm::length(committed.torque);
    for (int n = 0; n < 9; ++n) {
        rig.run(push, 1);
        CHECK(glm::length(rig.out.force) < last);
        CHECK(glm::length(rig.out.torque) < last_torque);
        last = glm::length(rig.out.force);
        last_torque = glm::length(rig.out.torque);
    }
    CHECK(last == 0.0);
}

TEST_CASE("a torque that is large holds off the engagement as a force does") {
    Rig rig;
    rig.run({{}, {0.0, 2.0 * rig.limits.engage_torque, 0.0}}, 500);
    CHECK_FALSE(rig.limiter.engaged());
    CHECK(rig.max_torque == 0.0);
}

TEST_CASE("a slow recovery takes its own ramp where that is longer than the engagement's") {
    Rig rig;
    rig.engage();
    rig.run(push, 50);
    rig.limiter.fail(control::Fault::late_commit);
    rig.run({}, 50);
    rig.limiter.recover_slowly(0.5);
    rig.run(push, 250);
    CHECK(rig.out.force.z == Approx(4.0).epsilon(0.05));
    rig.run(push, 300);
    CHECK(rig.out.force.z == Approx(8.0));
}

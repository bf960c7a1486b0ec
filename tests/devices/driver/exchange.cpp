// SPDX-License-Identifier: Apache-2.0
// What lies between a device's thread and the ticks, on a clock that the test sets.
#include "devices/driver/exchange.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <atomic>
#include <cmath>
#include <thread>

using namespace tactus;
using driver::Exchange;

namespace {

constexpr std::int64_t ms = 1'000'000;
std::int64_t clock_ns = 0;
std::int64_t now() noexcept { return clock_ns; }

driver::Reading at(double x) {
    driver::Reading reading;
    reading.pose.position.x = x;
    return reading;
}

struct Rig {
    Exchange exchange{now};

    Rig() {
        clock_ns = 1'000 * ms;
        exchange.begin({10.0, 0.0}, 1e-5, 1e-4);
    }
    /// A millisecond of an engine that wants `newton`; what the device is given then.
    double tick(double newton) {
        clock_ns += ms;
        exchange.commit({{newton, 0.0, 0.0}, {}});
        return exchange.force().force.x;
    }
    void engage() {
        for (int i = 0; i < 5; ++i) tick(0.0);
    }
};

}  // namespace

TEST_CASE("a sample is valid for 20 ms and not longer") {
    Rig rig;
    CHECK_FALSE(rig.exchange.newest().valid);  // there is none yet
    rig.exchange.publish(at(0.01));
    clock_ns += 20 * ms;
    CHECK(rig.exchange.newest().valid);
    clock_ns += 1;
    CHECK_FALSE(rig.exchange.newest().valid);
    CHECK(rig.exchange.newest().counter == 1);
    rig.exchange.publish(at(0.02));
    CHECK(rig.exchange.newest().valid);
    CHECK(rig.exchange.newest().counter == 2);
}

TEST_CASE("a force without a commit fades from 5 ms on and is zero after 10 ms") {
    Rig rig;
    rig.engage();
    CHECK(rig.tick(4.0) == 4.0);
    clock_ns += 5 * ms;
    CHECK(rig.exchange.force().force.x == 4.0);
    clock_ns += 25 * ms / 10;
    CHECK(rig.exchange.force().force.x == Approx(2.0));
    clock_ns += 25 * ms / 10;
    CHECK(rig.exchange.force().force.x == 0.0);
    CHECK(rig.tick(4.0) == 0.0);  // a large one does not come back by itself
    rig.exchange.publish(at(0.0));
    CHECK_FALSE(rig.exchange.newest().valid);  // the engine is told to let go
    rig.engage();
    CHECK(rig.tick(4.0) == 4.0);
    rig.exchange.publish(at(0.0));
    CHECK(rig.exchange.newest().valid);
}

TEST_CASE("an engine that ticks slowly has three of its periods") {
    Rig rig;
    rig.exchange.expect(1.0 / 60.0);
    rig.engage();
    CHECK(rig.tick(4.0) == 4.0);
    clock_ns += 49 * ms;
    CHECK(rig.exchange.force().force.x == 4.0);
    clock_ns += 7 * ms;
    CHECK(rig.exchange.force().force.x == 0.0);
}

TEST_CASE("forces beyond the limit are shortened, a limit of zero lets nothing pass") {
    Rig rig;
    rig.engage();
    clock_ns += ms;
    rig.exchange.commit({{30.0, 40.0, 0.0}, {0.0, 0.0, 1.0}});
    const Wrench given = rig.exchange.force();
    CHECK(glm::length(given.force) == Approx(10.0));
    CHECK(given.force.y / given.force.x == Approx(4.0 / 3.0));
    CHECK(given.torque == Vec3(0.0));
}

TEST_CASE("a clock that jumps takes force and sample away, and they come back") {
    for (const std::int64_t jump : {3'600'000 * ms, -500 * ms}) {
        CAPTURE(jump);
        Rig rig;
        rig.engage();
        rig.exchange.publish(at(0.01));
        CHECK(rig.tick(4.0) == 4.0);
        clock_ns += jump;
        CHECK_FALSE(rig.exchange.newest().valid);
        rig.exchange.force();
        clock_ns += 5 * ms;
        CHECK(rig.exchange.force().force.x == 0.0);
        rig.engage();
        clock_ns += 5 * ms;
        rig.engage();
        CHECK(rig.tick(4.0) == 4.0);
        rig.exchange.publish(at(0.02));
        CHECK(rig.exchange.newest().valid);
        CHECK(rig.exchange.newest().twist.linear.x == 0.0);  // no way of an hour, or of a step back
    }
}

TEST_CASE("a burst makes no velocity that the hand never had") {
    Rig rig;
    double fastest = 0.0;
    for (int i = 0; i < 200; ++i) {
        clock_ns += ms;
        // 0.1 m/s; every tenth time, five samples of one millisecond arrive at once, 2 µs apart.
        if (i % 10 == 0)
            for (int n = 0; n < 5; ++n) {
                clock_ns += 2'000;
                rig.exchange.publish(at(0.1e-3 * (i + 0.2 * n - 1.0)));
            }
        else rig.exchange.publish(at(0.1e-3 * i));
        if (i > 20) fastest = std::max(fastest, std::abs(rig.exchange.newest().twist.linear.x - 0.1));
    }
    CHECK(fastest < 0.15);  // by their stamps, the samples of a burst are 10 m/s apart
}

TEST_CASE("the spin of a handle that goes round and round has no seam") {
    Rig rig;
    double off = 0.0;
    for (int i = 0; i < 1000; ++i) {
        clock_ns += ms;
        driver::Reading reading;
        const double half = 0.5 * 10.0 * 1e-3 * i;  // 10 rad/s
        reading.pose.orientation = Quat(std::cos(half), 0.0, 0.0, std::sin(half));
        rig.exchange.publish(reading);
        if (i > 20) off = std::max(off, std::abs(rig.exchange.newest().twist.angular.z - 10.0));
    }
    CHECK(off < 0.1);
}

TEST_CASE("what is no number is never a sample and never a force") {
    Rig rig;
    rig.engage();
    CHECK(rig.tick(4.0) == 4.0);
    CHECK(rig.tick(std::nan("")) == 0.0);
    for (int part = 0; part < 3; ++part) {
        driver::Reading reading = at(0.0);
        if (part == 0) reading.pose.position.y = std::nan("");
        if (part == 1) reading.pose.orientation = Quat(0.0, 0.0, 0.0, 0.0);
        if (part == 2) {
            reading.has_twist = true;
            reading.twist.angular.z = INFINITY;
        }
        rig.exchange.publish(reading);
        CHECK_FALSE(rig.exchange.newest().valid);
    }
    rig.exchange.publish(at(0.01));
    CHECK_FALSE(rig.exchange.newest().valid);  // the gate holds until small forces are wanted
    rig.engage();
    rig.exchange.publish(at(0.01));
    CHECK(rig.exchange.newest().valid);
}

TEST_CASE("both sides of an exchange neither allocate nor wait") {
    Rig rig;
    const RealtimeViolations seen = watch([&] {
        for (int i = 0; i < 100; ++i) {
            rig.exchange.publish(at(0.001 * i));
            rig.exchange.newest();
            rig.tick(1.0);
        }
    });
    CHECK(seen.describe() == "none");
}

TEST_CASE("two threads exchange whole samples and whole forces") {
    Exchange exchange;
    exchange.begin({1e9, 1e9}, 1e-5, 1e-4);
    std::atomic<bool> ends{false};
    std::atomic<int> torn{0};
    std::thread device([&] {
        for (int i = 1; !ends; ++i) {
            const double x = i % 1000;
            driver::Reading reading;
            reading.pose.position = Vec3(x, 2.0 * x, 3.0 * x);
            reading.has_twist = true;
            exchange.publish(reading);
            const Vec3 f = exchange.force().force;
            if (f.y != 2.0 * f.x) ++torn;
        }
    });
    for (int i = 0; i < 200'000; ++i) {
        const Vec3 p = exchange.newest().pose.position;
        if (p.y != 2.0 * p.x || p.z != 3.0 * p.x) ++torn;
        const double f = 1e-3 * (i % 7);
        exchange.commit({{f, 2.0 * f, 0.0}, {}});
    }
    ends = true;
    device.join();
    CHECK(torn == 0);
}

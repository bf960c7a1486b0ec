// SPDX-License-Identifier: Apache-2.0
// A gamepad whose events come through a pipe.
#include "devices/haptic/gamepad.hpp"
#include "dsp/core/clock.hpp"

#include "devices/haptic/pulled_hand.hpp"
#include "tests/devices/driver/event_peer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>
#include <glm/geometric.hpp>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

using namespace tactus;

namespace {

/// The gamepad and who holds it. A pipe has no axes to ask for, so the usual ranges hold.
struct Rig {
    std::filesystem::path folder;
    int end = -1;
    std::unique_ptr<HapticDevice> device;

    Rig() {
        char made[] = "/tmp/tactus-pad-XXXXXX";
        REQUIRE(::mkdtemp(made));
        folder = made;
        const std::string path = (folder / "pad").string();
        REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
        end = ::open(path.c_str(), O_RDWR | O_NONBLOCK);
        REQUIRE(end >= 0);
        Options options("device 'pad'", {{"file", path, {}}});
        device = haptic::open_gamepad(options, [](const std::string& name) { return std::filesystem::path(name); });
        device->prepare(1e-3);
    }
    ~Rig() {
        if (end >= 0) ::close(end);
        device.reset();
        std::filesystem::remove_all(folder);
    }
    void say(std::uint16_t type, std::uint16_t code, int value) const {
        input_event events[2]{};
        events[0].type = type;
        events[0].code = code;
        events[0].value = value;
        events[1].type = EV_SYN;
        REQUIRE(::write(end, events, sizeof events) == sizeof events);
    }
    /// Ticks until it holds; the thread that reads needs its moment.
    template <class Condition>
    bool ticks_until(Condition&& holds) {
        for (int n = 0; n < 5000; ++n) {
            if (holds(device->acquire(1e-3))) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }
};

}  // namespace

TEST_CASE("a gamepad that rests is a valid hand with fresh samples") {
    Rig rig;
    for (int n = 0; n < 1000; ++n) {
        const DeviceSample sample = rig.device->acquire(1e-3);
        REQUIRE(sample.valid);
        REQUIRE(sample.counter == n + 1);
        REQUIRE(glm::length(sample.pose.position) < 1e-12);
    }
}

TEST_CASE("sticks and triggers give the speed of the hand, and rest within a tenth of their way") {
    haptic::PadState state;
    state.axes[0] = 0.09;
    state.axes[3] = -0.1;
    CHECK(glm::length(haptic::twist_of(state, 0.1, 1.0).linear) == 0.0);
    CHECK(glm::length(haptic::twist_of(state, 0.1, 1.0).angular) == 0.0);
    state.axes = {1.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    state.rolls = 2;
    const Twist fast = haptic::twist_of(state, 0.1, 1.0);
    CHECK(glm::length(fast.linear - Vec3(0.1)) < 1e-12);
    CHECK(fast.angular.y == 1.0);
    state.axes[0] = std::nan("");
    CHECK(haptic::twist_of(state, 0.1, 1.0).linear.x == 0.0);
}

TEST_CASE("a stick moves the hand no faster than its speed, and a button is its trigger") {
    Rig rig;
    rig.say(EV_ABS, ABS_X, 32767);
    rig.say(EV_KEY, BTN_SOUTH, 1);
    REQUIRE(rig.ticks_until([](const DeviceSample& s) { return s.pose.position.x > 0.005 && s.buttons == 1u; }));
    const double from = rig.device->acquire(1e-3).pose.position.x;
    DeviceSample sample;
    for (int n = 0; n < 100; ++n) sample = rig.device->acquire(1e-3);
    CHECK(sample.pose.position.x - from == Approx(0.01).epsilon(0.02));
    CHECK(std::abs(sample.pose.position.y) < 1e-9);
}

TEST_CASE("when the system lost events of a gamepad, what it held before holds no longer") {
    Rig rig;
    rig.say(EV_ABS, ABS_X, 32767);
    rig.say(EV_KEY, BTN_SOUTH, 1);
    REQUIRE(rig.ticks_until([](const DeviceSample& s) { return s.twist.linear.x > 0.05 && s.buttons == 1u; }));
    input_event lost[2]{};
    lost[0].type = EV_SYN;
    lost[0].code = SYN_DROPPED;
    lost[1].type = EV_ABS;  // the rest of a report whose beginning is lost
    lost[1].code = ABS_Y;
    lost[1].value = 32767;
    REQUIRE(::write(rig.end, lost, sizeof lost) == sizeof lost);
    rig.say(EV_KEY, BTN_EAST, 1);
    REQUIRE(
        rig.ticks_until([](const DeviceSample& s) { return glm::length(s.twist.linear) < 1e-3 && s.buttons == 0u; }));
    for (int n = 0; n < 200; ++n) rig.device->acquire(1e-3);
    const Vec3 from = rig.device->acquire(1e-3).pose.position;
    for (int n = 0; n < 100; ++n) rig.device->acquire(1e-3);
    CHECK(glm::length(rig.device->acquire(1e-3).pose.position - from) < 1e-4);
    rig.say(EV_ABS, ABS_X, 32767);  // and it goes on
    CHECK(rig.ticks_until([](const DeviceSample& s) { return s.twist.linear.x > 0.05; }));
}

TEST_CASE("a gamepad that is unplugged gives no valid sample any more, and its buttons are let go") {
    Rig rig;
    rig.say(EV_KEY, BTN_SOUTH, 1);
    REQUIRE(rig.ticks_until([](const DeviceSample& s) { return s.buttons == 1u; }));
    ::close(rig.end);
    rig.end = -1;
    REQUIRE(rig.ticks_until([](const DeviceSample& s) { return !s.valid; }));
    for (int n = 0; n < 100; ++n) {
        const DeviceSample sample = rig.device->acquire(1e-3);
        REQUIRE_FALSE(sample.valid);
        REQUIRE(sample.buttons == 0u);
    }
}

TEST_CASE("a gamepad tells where its sticks want the hand and what it feels until it is unplugged") {
    Rig rig;
    const auto* const pulled = dynamic_cast<const haptic::PulledDevice*>(rig.device.get());
    REQUIRE(pulled);
    const auto link = pulled->pull();
    haptic::PulledHand told;
    std::uint64_t number = 1;
    REQUIRE(link->read(told, number));
    CHECK(number == 0);
    rig.say(EV_ABS, ABS_X, 32767);
    REQUIRE(rig.ticks_until([](const DeviceSample& s) { return s.twist.linear.x > 0.05; }));
    const Wrench force{{-10.0, 0.0, 0.0}, {}};
    rig.device->commit(force);
    DeviceSample sample;
    for (int n = 0; n < 2000; ++n) sample = rig.device->acquire(1e-3);
    REQUIRE(link->read(told, number));
    CHECK(number != 0);
    CHECK(told.pose.position == sample.pose.position);
    CHECK(told.force.force == force.force);
    // A spring of 2 N/mm.
    CHECK(told.wanted.position.x - told.pose.position.x == Approx(0.005).margin(0.0005));
    CHECK(told.at_ns <= steady_ns());
    const RealtimeViolations seen = watch([&] {
        for (int n = 0; n < 100; ++n) {
            rig.device->acquire(1e-3);
            rig.device->commit(force);
        }
    });
    CHECK(seen.describe() == "none");
    ::close(rig.end);
    rig.end = -1;
    REQUIRE(rig.ticks_until([](const DeviceSample& s) { return !s.valid; }));
    REQUIRE(link->read(told, number));
    const std::uint64_t last = number;
    for (int n = 0; n < 10; ++n) rig.device->acquire(1e-3);
    REQUIRE(link->read(told, number));
    CHECK(number == last);
}

TEST_CASE("without a gamepad the driver says what to do") {
    Options options("device 'pad'", {{"file", "/nowhere/event7", {}}});
    CHECK_THROWS_WITH(
        haptic::open_gamepad(options, [](const std::string& name) { return std::filesystem::path(name); }),
        Catch::Matchers::ContainsSubstring("cannot open /nowhere/event7"));
}

namespace {

/// A gamepad of the stand-in for the kernel, with motors.
struct RumblePad {
    test::FakeEvents events;
    std::unique_ptr<HapticDevice> device;

    RumblePad() {
        events.axes[ABS_X] = {.value = 0, .minimum = -128, .maximum = 127, .fuzz = 0, .flat = 0, .resolution = 0};
        events.keys = {BTN_SOUTH, BTN_EAST};
        events.effects = {FF_RUMBLE, FF_GAIN};
    }
    void open(std::vector<OptionText> given = {}) {
        Options options("device 'pad'", std::move(given));
        device = haptic::open_gamepad_of(events, options);
        device->prepare(1e-3);
    }
    int strength() {
        int sum = 0;
        for (const ff_effect& one : events.playing()) sum += one.u.rumble.strong_magnitude;
        return sum;
    }
    bool reaches(int wanted) {
        for (int n = 0; n < 2000; ++n) {
            if (std::abs(strength() - wanted) <= 1) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }
};

}  // namespace

TEST_CASE("the motors of a gamepad rumble as large as the force is, and rest without one and at the end") {
    RumblePad pad;
    pad.open({{"rumble", "8 N", {}}});
    CHECK(pad.events.gain == 0xFFFF);
    pad.device->commit({{0.0, 1.2, -1.6}, {}});
    CHECK(pad.reaches(65535 / 4));
    pad.device->commit({{0.0, 100.0, 0.0}, {}});
    CHECK(pad.reaches(65535));
    pad.device->commit({{std::nan(""), 0.0, 0.0}, {}});
    CHECK(pad.reaches(0));
    pad.device->commit({{8.0, 0.0, 0.0}, {}});
    CHECK(pad.reaches(65535));
    pad.device.reset();
    CHECK(pad.events.uploaded() == 0);
    CHECK(pad.events.open_files() == 0);
}

TEST_CASE("a gamepad that may only be read, or whose motors are to rest, still has its sticks") {
    for (const bool is_read_only : {true, false}) {
        RumblePad pad;
        pad.events.is_read_only = is_read_only;
        pad.open(is_read_only ? std::vector<OptionText>{} : std::vector<OptionText>{{"rumble", "0 N", {}}});
        pad.events.say(EV_ABS, ABS_X, 127);
        bool has_moved = false;
        for (int n = 0; n < 2000 && !has_moved; ++n) {
            has_moved = pad.device->acquire(1e-3).pose.position.x > 0.005;
            pad.device->commit({{5.0, 0.0, 0.0}, {}});
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        CHECK(has_moved);
        CHECK(pad.events.uploaded() == 0);
    }
}

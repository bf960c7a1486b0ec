// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/mouse.hpp"

#include "devices/haptic/catalogue.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace tactus;

namespace {

constexpr std::int64_t millisecond = 1'000'000;
std::int64_t clock_ns = 0;  // of the driver: a function pointer holds nothing

/// A device and its window, tick by tick.
struct Rig {
    haptic::WindowHand link;
    std::unique_ptr<HapticDevice> device;
    haptic::FeltHand felt;

    explicit Rig(std::vector<OptionText> settings = {}) {
        clock_ns = 1'000'000'000;
        Options options("device 'mouse'", std::move(settings));
        device = haptic::open_mouse(options, link, [] { return clock_ns; });
        device->prepare(1e-3);
        look();
    }
    void look() {
        std::uint64_t number = 0;
        REQUIRE(link.felt.read(felt, number));
    }
    void say(const Vec3& at, double picture_s, std::int64_t buttons = 0) {
        link.wanted.write(
            {{at, {1.0, 0.0, 0.0, 0.0}}, buttons, clock_ns, static_cast<std::int64_t>(picture_s * 1e9), felt.run});
    }
    DeviceSample tick() {
        clock_ns += millisecond;
        const DeviceSample sample = device->acquire(1e-3);
        look();
        return sample;
    }
    DeviceSample ticks(int count) {
        DeviceSample sample;
        for (int n = 0; n < count; ++n) sample = tick();
        return sample;
    }
};

}  // namespace

TEST_CASE("a mouse that rests is a valid hand with fresh samples") {
    Rig rig;
    for (int n = 0; n < 3000; ++n) {
        if (n % 33 == 0) rig.say({0.0, 0.0, 0.0}, 0.033);
        const DeviceSample sample = rig.tick();
        REQUIRE(sample.valid);
        REQUIRE_FALSE(sample.late);
        REQUIRE(sample.counter == n + 1);
        REQUIRE(glm::length(sample.pose.position) < 1e-9);
    }
}

TEST_CASE("the hand goes from picture to picture in a straight line, without a jump of its speed at each") {
    Rig rig;
    double fastest = 0.0, slowest = 1.0;
    for (int picture = 1; picture <= 40; ++picture) {
        rig.say({1e-3 * picture, 0.0, 0.0}, 0.02);
        for (int n = 0; n < 20; ++n) {
            const double speed = rig.tick().twist.linear.x;
            if (picture < 10) continue;
            fastest = std::max(fastest, speed);
            slowest = std::min(slowest, speed);
        }
    }
    // 1 mm in each picture of 20 ms.
    CHECK(fastest == Approx(0.05).epsilon(0.02));
    CHECK(slowest == Approx(0.05).epsilon(0.02));
    CHECK(rig.felt.pose.position.x == Approx(0.04).margin(0.5e-3));
}

TEST_CASE("the hand goes on at the same speed between pictures that take a third of a second") {
    Rig rig;
    double fastest = 0.0, slowest = 1.0;
    for (int picture = 1; picture <= 10; ++picture)
        for (int n = 0; n < 330; ++n) {
            if (n % 20 == 0) rig.say({0.01 * picture, 0.0, 0.0}, 0.33);
            const double speed = rig.tick().twist.linear.x;
            if (picture < 3) continue;
            fastest = std::max(fastest, speed);
            slowest = std::min(slowest, speed);
        }
    CHECK(fastest == Approx(0.01 / 0.33).epsilon(0.05));
    CHECK(slowest == Approx(0.01 / 0.33).epsilon(0.05));
}

TEST_CASE("a window moves one device at a time") {
    Rig rig;
    Options options("device 'other'");
    try {
        haptic::open_mouse(options, rig.link, [] { return clock_ns; });
        FAIL("it was opened");
    } catch (const Error& error) {
        CHECK(std::string(error.what()).find("device 'other': the window has one hand") != std::string::npos);
    }
    rig.device.reset();
    Options again("device 'other'");
    CHECK(haptic::open_mouse(again, rig.link, [] { return clock_ns; }) != nullptr);
}

TEST_CASE("a hand at the window refuses the model of a device that it does not simulate") {
    haptic::WindowHand link;
    Options options("device 'mouse'", {{"model", "touch", {}}});
    CHECK_THROWS_AS(haptic::open_mouse(options, link, [] { return clock_ns; }), Error);
    CHECK(link.devices == 0);
}

TEST_CASE("a window that says several times in a picture that it is alive does not slow the hand down") {
    const auto arrives = [](bool repeats) {
        Rig rig;
        rig.say({5e-3, 0.0, 0.0}, 0.03);
        for (int n = 0; n < 40; ++n) {
            if (repeats && n % 5 == 0) rig.say({5e-3, 0.0, 0.0}, 0.03);
            rig.tick();
        }
        return rig.felt.pose.position.x;
    };
    CHECK(arrives(true) == arrives(false));
}

TEST_CASE("no hand jumps: a cursor that is thrown across the scene is followed at half a metre per second") {
    Rig rig;
    rig.say({0.2, 0.0, 0.0}, 0.016);
    double fastest = 0.0;
    for (int n = 0; n < 90; ++n) {
        if (n > 0 && n % 10 == 0) rig.say({0.2, 0.0, 0.0}, 0.016);
        fastest = std::max(fastest, rig.tick().twist.linear.x);
    }
    CHECK(fastest < 0.65);
    CHECK(rig.felt.pose.position.x < 0.06);
}

TEST_CASE("a window that is silent for 100 ms has lost the hand, until it speaks again, and after 1 s its buttons") {
    Rig rig;
    rig.say({0.0, 0.0, 0.0}, 0.016, button_trigger);
    CHECK((rig.ticks(99).buttons & button_trigger) != 0);
    DeviceSample sample = rig.ticks(2);
    CHECK(sample.late);
    // A slow picture does not drop what is held.
    CHECK((sample.buttons & button_trigger) != 0);
    CHECK(sample.valid);
    CHECK(rig.felt.is_silent == 1);
    CHECK((rig.ticks(898).buttons & button_trigger) != 0);
    sample = rig.ticks(2);
    CHECK(sample.late);
    CHECK(sample.buttons == 0);
    rig.say({0.0, 0.0, 0.0}, 0.6, button_trigger);
    sample = rig.tick();
    CHECK_FALSE(sample.late);
    CHECK((sample.buttons & button_trigger) != 0);
}

TEST_CASE("the hand yields to force by its grip, and tells the window what it feels") {
    Rig rig;
    const Wrench push{{0.0, 0.0, 10.0}, {}};
    for (int n = 0; n < 1000; ++n) {
        if (n % 16 == 0) rig.say({0.0, 0.0, 0.0}, 0.016);
        rig.device->commit(push);
        rig.tick();
    }
    // A firm grip: 2 N/mm.
    CHECK(rig.felt.pose.position.z == Approx(5e-3).epsilon(0.02));
    CHECK(rig.felt.force.force.z == 10.0);
    Rig soft(std::vector<OptionText>{{"stiffness", "500 N/m", {}}});
    for (int n = 0; n < 2000; ++n) {
        soft.device->commit(push);
        soft.tick();
    }
    CHECK(soft.felt.pose.position.z == Approx(20e-3).epsilon(0.02));
}

TEST_CASE("a mouse pushes with its strength and no more, and rests while a tick is late") {
    const auto pulled_by = [](const char* strength, double push) {
        Rig rig(std::vector<OptionText>{{"max_force", strength, {}}});
        CHECK(rig.device->info().without_motors);
        // The cursor is 30 mm away, which a grip of 2 N/mm would pull with 60 N.
        for (int n = 0; n < 1500; ++n) {
            if (n % 16 == 0) rig.say({30e-3, 0.0, 0.0}, 0.016);
            rig.device->commit({{-push, 0.0, 0.0}, {}});
            rig.tick();
        }
        return rig.felt.pose.position.x;
    };
    CHECK(pulled_by("20 N", 15.0) == Approx(22.5e-3).epsilon(0.02));
    CHECK(pulled_by("20 N", 21.0) < 0.0);
    CHECK(pulled_by("100 N", 21.0) == Approx(19.5e-3).epsilon(0.02));

    Rig rig;
    rig.say({0.02, 0.0, 0.0}, 0.016);
    rig.ticks(10);
    const double before = rig.felt.pose.position.x;
    rig.device->acquire(0.2);
    rig.look();
    CHECK(rig.felt.pose.position.x - before < 5e-3);
}

TEST_CASE("what a window says for an earlier run, or what is no pose, does not move the hand") {
    Rig rig;
    const std::int64_t before = rig.felt.run;
    rig.say({0.05, 0.0, 0.0}, 0.016);
    rig.device->prepare(1e-3);
    rig.ticks(50);
    CHECK(rig.felt.run == before + 1);
    CHECK(glm::length(rig.felt.pose.position) < 1e-9);
    rig.say({std::nan(""), 0.0, 0.0}, 0.016);
    CHECK(is_valid(rig.ticks(50).pose));
    rig.say({1e6, 0.0, 0.0}, 0.016);
    CHECK(glm::length(rig.ticks(50).pose.position) < 1e-9);
}

TEST_CASE("the mouse is a driver of the catalogue that needs a window") {
    CHECK(haptic::needs_window("mouse"));
    CHECK_FALSE(haptic::needs_window("simulated"));
    CHECK_FALSE(haptic::is_real_driver("mouse"));
}

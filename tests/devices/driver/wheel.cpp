// SPDX-License-Identifier: Apache-2.0
// What a wheel does beyond what every driver promises (conformance.cpp).
#include "devices/evdev/wheel.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/devices/driver/event_peer.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

using namespace tactus;
using namespace tactus::test;

namespace {

struct Rig {
    FakeEvents events;
    std::shared_ptr<driver::Exchange> exchange = std::make_shared<driver::Exchange>();
    std::unique_ptr<driver::Backend> wheel;
    driver::Opened opened;

    Rig() {
        events.axes[ABS_X] = {.value = 0, .minimum = -1000, .maximum = 1000, .fuzz = 0, .flat = 0, .resolution = 0};
        events.keys = {BTN_TRIGGER};
        events.effects = {FF_CONSTANT, FF_GAIN, FF_AUTOCENTER};
    }
    void open(std::vector<OptionText> given = {}, driver::OpenMode mode = driver::OpenMode::run) {
        Options options = options_of(std::move(given));
        wheel = evdev::make_wheel_of(events, options);
        options.finish();
        opened = wheel->open(mode, exchange, [](const std::string&) {});
        exchange->begin({opened.info.max_force, 0.0}, 1e-6, 1e-6);
        for (int i = 0; i < 5; ++i) {  // forces begin with small ones
            exchange->commit({});
            exchange->force();
        }
    }
    bool push(const Vec3& force) {
        exchange->commit({force, {}});
        return wheel->round(*exchange);
    }
    double level() {
        double sum = 0.0;
        for (const ff_effect& one : events.playing()) sum += one.u.constant.level;
        return sum;
    }
};

}  // namespace

TEST_CASE("a wheel has the range that its option gives, else the one of its driver, else 900 degrees") {
    for (const auto& [given, stated, degrees] : {std::tuple{"270 deg", "540", 270.0}, std::tuple{"", "540", 540.0},
                                                 std::tuple{"", "", 900.0}, std::tuple{"", "nonsense", 900.0}}) {
        Rig rig;
        rig.events.range = stated;
        rig.open(*given ? std::vector<OptionText>{{"range", given, {}}, {"moves", "rim", {}}}
                        : std::vector<OptionText>{{"moves", "rim", {}}});
        rig.events.say(EV_ABS, ABS_X, 100);
        REQUIRE(rig.push({}));
        const DeviceSample sample = rig.exchange->newest();
        const double angle = degrees * std::numbers::pi / 180.0 * 100.0 / 2000.0;
        CAPTURE(stated, degrees);
        const Vec3 turned = rotation_between(Quat(1.0, 0.0, 0.0, 0.0), sample.pose.orientation);
        CHECK(turned.y == Approx(angle).epsilon(1e-12));
        CHECK(sample.pose.position.x == Approx(0.14 * std::sin(angle)).epsilon(1e-12));
        CHECK(sample.pose.position.z == Approx(0.14 * (std::cos(angle) - 1.0)).epsilon(1e-12));
    }
}

TEST_CASE("centring is switched off, the gain is full, and nothing of it is left at the wheel at the end") {
    Rig rig;
    rig.open();
    CHECK(rig.events.autocenter == 0);
    CHECK(rig.events.gain == 0xFFFF);
    REQUIRE(rig.push({1.0, 0.0, 0.0}));
    CHECK(rig.level() == -std::lround(32767.0 * 0.14 / 30.0));
    CHECK(rig.events.uploaded() == 1);
    rig.wheel->close();
    CHECK(rig.events.uploaded() == 0);
    CHECK(rig.events.playing().empty());
    CHECK(rig.events.open_files() == 0);
}

TEST_CASE("a wheel that is closed centres as before, and one that was only read was not touched") {
    const struct {
        std::string stated;
        std::vector<OptionText> given;
        int centring, gain;
    } cases[] = {{"13107", {}, 13107, 0xFFFF},
                 {"13107", {{"centring_after", "0.5", {}}}, 13107, 0xFFFF},
                 {"", {}, 0, 0xFFFF},
                 {"", {{"centring_after", "0.5", {}}, {"gain_after", "0.2", {}}}, 32768, 13107},
                 {"on", {{"centring_after", "1", {}}}, 0xFFFF, 0xFFFF}};
    for (const auto& one : cases) {
        CAPTURE(one.stated, one.centring);
        Rig rig;
        rig.events.stated_centring = one.stated;
        rig.open(one.given);
        REQUIRE(rig.push({1.0, 0.0, 0.0}));
        CHECK(rig.events.autocenter == 0);
        CHECK(rig.events.gain == 0xFFFF);
        rig.wheel->close();
        CHECK(rig.events.autocenter == one.centring);
        CHECK(rig.events.gain == one.gain);
        rig.events.autocenter = rig.events.gain = -1;
        rig.wheel->close();
        CHECK(rig.events.autocenter == -1);
    }
    Rig read;
    read.open({}, driver::OpenMode::reading);
    read.wheel->close();
    CHECK(read.events.autocenter == -1);
    CHECK(read.events.gain == -1);
    Rig plain;  // a wheel that knows neither
    plain.events.effects = {FF_CONSTANT};
    plain.open();
    plain.wheel->close();
    CHECK(plain.events.autocenter == -1);
    CHECK(plain.events.gain == -1);
}

TEST_CASE("a joystick with force feedback is not taken for a wheel unless it is named") {
    const auto opens = [](const std::function<void(FakeEvents&)>& change, std::vector<OptionText> given = {}) {
        Rig rig;
        rig.events.range.clear();
        rig.events.name = "Sidewinder Force";
        rig.events.axes[ABS_Y] = rig.events.axes[ABS_X];
        change(rig.events);
        try {
            rig.open(std::move(given));
        } catch (const Error& error) {
            return error.message();
        }
        return std::string("opened");
    };
    CHECK(opens([](FakeEvents&) {}) ==
          "there is no wheel with force feedback in /dev/input; 'Sidewinder Force' seems to be a joystick: if it is a "
          "wheel, give /dev/input/event7 as 'file'");
    CHECK(opens([](FakeEvents&) {}, {{"file", "/dev/input/event7", {}}}) == "opened");
    CHECK(opens([](FakeEvents& e) { e.range = "540"; }) == "opened");
    CHECK(opens([](FakeEvents& e) { e.name = "G29 Driving Force RACING Wheel"; }) == "opened");
    CHECK(opens([](FakeEvents& e) { e.axes[ABS_WHEEL] = e.axes[ABS_X]; }) == "opened");
    CHECK(opens([](FakeEvents& e) { e.keys.push_back(BTN_GEAR_DOWN); }) == "opened");
    CHECK(opens([](FakeEvents& e) { e.axes.erase(ABS_Y); }) == "opened");
}

TEST_CASE("a wheel whose driver hangs gives no force after a tenth of a second, and one that is pushed goes on",
          "[virtual]") {
    const VirtualClock clock;
    Rig rig;
    rig.open();
    for (int i = 0; i < 150; ++i) {
        REQUIRE(rig.push({1.0, 0.0, 0.0}));
        CHECK(rig.level() != 0.0);
        sleep_until(steady_ns() + 2 * ms);
    }
    CHECK(rig.events.uploads <= 3);  // its line is told changes only
    sleep_until(steady_ns() + 101 * ms);
    CHECK(rig.events.playing().empty());
    REQUIRE(rig.push({1.0, 0.0, 0.0}));
    REQUIRE(rig.push({0.0, 0.0, 0.0}));
    CHECK(rig.level() == 0.0);
}

TEST_CASE("the torque of a wheel is what the force does when its rim turns") {
    Rig rig;
    rig.open({{"moves", "rim", {}}, {"max_torque", "3 N m", {}}, {"radius", "200 mm", {}}});
    rig.events.say(EV_ABS, ABS_X, 150);
    for (const Vec3& force : {Vec3(2.0, 0.0, 0.0), Vec3(0.0, 5.0, 0.0), Vec3(1.0, 1.0, -3.0)}) {
        REQUIRE(rig.push(force));
        const double angle = 2.5 * 2.0 * std::numbers::pi * 150.0 / 2000.0, step = 1e-6;
        const auto at = [](double a) { return 0.2 * Vec3(std::sin(a), 0.0, std::cos(a) - 1.0); };
        const double work = glm::dot(force, at(angle + step) - at(angle - step)) / (2.0 * step);
        CHECK(rig.level() == Approx(-32767.0 * work / 3.0).margin(0.51));
    }
}

TEST_CASE("a wheel whose torque nobody has stated pushes no harder than the strongest one would, and says so") {
    Rig assumed, stated;
    assumed.open();
    stated.open({{"max_torque", "8 N m", {}}});
    CHECK_THAT(assumed.opened.versions.back(), Catch::Matchers::ContainsSubstring("30 N m, the strongest sold"));
    REQUIRE(assumed.push({10.0, 0.0, 0.0}));
    CHECK(std::abs(assumed.level()) == std::lround(32767.0 * 10.0 * 0.14 / 30.0));
    CHECK(stated.opened.versions.back() == "full torque 8 N m, by option");
}

TEST_CASE("a reversed wheel pushes the other way, and what was confirmed of it does not count for the other") {
    Rig straight, reversed;
    straight.open();
    reversed.open({{"reversed", "true", {}}});
    REQUIRE(straight.push({1.0, 0.0, 0.0}));
    REQUIRE(reversed.push({1.0, 0.0, 0.0}));
    CHECK(straight.level() == -reversed.level());
    CHECK(straight.opened.setup != reversed.opened.setup);
    CHECK(straight.opened.serial == "W7");
}

TEST_CASE("events that the system lost are asked for anew") {
    Rig rig;
    rig.open();
    rig.events.say(EV_KEY, BTN_TRIGGER, 1);
    REQUIRE(rig.push({}));
    CHECK(rig.exchange->newest().buttons == button_trigger);
    rig.events.say(EV_KEY, BTN_TRIGGER, 0);  // lost with the next line
    rig.events.drop(EV_ABS, ABS_X, 300);
    REQUIRE(rig.push({}));
    const DeviceSample sample = rig.exchange->newest();
    CHECK(sample.buttons == 0u);
    CHECK(sample.pose.position.x == Approx(0.14 * 5.0 * std::numbers::pi * 300.0 / 2000.0));
}

TEST_CASE("a wheel that refuses forces is lost, one that refuses once is not", "[virtual]") {
    const VirtualClock clock;
    Rig rig;
    rig.open();
    rig.events.refuses = true;
    REQUIRE(rig.push({1.0, 0.0, 0.0}));
    rig.events.refuses = false;
    REQUIRE(rig.push({1.0, 0.0, 0.0}));
    CHECK(rig.level() != 0.0);
    rig.events.refuses = true;
    const std::int64_t begin = steady_ns();
    double wanted = 0.5;
    while (rig.push({wanted = 1.5 - wanted, 0.0, 0.0}) && steady_ns() - begin < 2000 * ms)
        sleep_until(steady_ns() + 2 * ms);
    CHECK(steady_ns() - begin < 1000 * ms);
}

TEST_CASE("what is no wheel is refused by name, and by what it lacks") {
    const auto refusal = [](const std::function<void(FakeEvents&)>& change, std::vector<OptionText> given = {}) {
        Rig rig;
        change(rig.events);
        try {
            rig.open(std::move(given));
        } catch (const Error& error) {
            CHECK(rig.events.uploaded() == 0);
            return std::string(error.what());
        }
        return std::string("opened");
    };
    const std::vector<OptionText> at{{"file", "/dev/input/event7", {}}};
    using Catch::Matchers::ContainsSubstring;
    CHECK_THAT(refusal([](FakeEvents& e) { e.effects = {FF_RUMBLE}; }),
               ContainsSubstring("no wheel with force feedback"));
    CHECK_THAT(refusal([](FakeEvents& e) { e.effects = {FF_RUMBLE}; }, at), ContainsSubstring("it only rumbles"));
    CHECK_THAT(refusal([](FakeEvents& e) { e.axes.clear(); }, at), ContainsSubstring("states no range"));
    CHECK_THAT(refusal([](FakeEvents& e) { e.axes[ABS_X].maximum = -1000; }), ContainsSubstring("states no range"));
    CHECK_THAT(refusal([](FakeEvents& e) { e.is_read_only = true; }), ContainsSubstring("group 'input'"));
    CHECK_THAT(refusal([](FakeEvents& e) { e.unplug(true); }, at), ContainsSubstring("cannot open /dev/input/event7"));
}

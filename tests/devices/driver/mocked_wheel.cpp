// SPDX-License-Identifier: Apache-2.0
// The wheel's driver on an event device of umockdev (tests/support/mock_wheel.cpp), through the system calls that it makes
// on a real one, in the process that a live run gives it: found, pushed, its process or its engine killed, unplugged.
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#ifdef TACTUS_MOCK_WHEEL

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double pushes = 0.3;  // N, less than an unconfirmed wheel may give
const long level = std::lround(32767.0 * pushes * 0.14 / 2.0);

/// The wheel; processes that are started while it lives see it in /dev and /sys.
class Mock {
public:
    struct State {
        int playing = 0, effects = -1, gain = 0, centring = 0, files = 0, played = 0;
    };

    Mock() {
        int to[2] = {-1, -1}, from[2] = {-1, -1};
        REQUIRE((::pipe(to) == 0 && ::pipe(from) == 0));
        process_ = ::fork();
        if (process_ == 0) {
            ::dup2(to[0], 0);
            ::dup2(from[1], 1);
            for (const int end : {to[0], to[1], from[0], from[1]}) ::close(end);
            ::execl(TACTUS_MOCK_WHEEL, TACTUS_MOCK_WHEEL, nullptr);
            ::_exit(127);
        }
        ::close(to[0]);
        ::close(from[1]);
        commands_ = ::fdopen(to[1], "w");
        answers_ = ::fdopen(from[0], "r");
        folder_ = line();
        REQUIRE_FALSE(folder_.empty());
        folder_.pop_back();
        host_ = (std::filesystem::path(command()).parent_path() / "tactus-device-host").string();
        config_ = std::filesystem::temp_directory_path() / ("tactus_wheel_" + std::to_string(::getpid()));
        ::setenv("UMOCKDEV_DIR", folder_.c_str(), 1);
        ::setenv("XDG_CONFIG_HOME", config_.c_str(), 1);
        ::setenv("TACTUS_DEVICE_HOST", host_.c_str(), 1);
        ::setenv("LD_PRELOAD", TACTUS_MOCK_PRELOAD, 1);
    }
    ~Mock() {
        for (const char* name : {"UMOCKDEV_DIR", "XDG_CONFIG_HOME", "TACTUS_DEVICE_HOST", "LD_PRELOAD"})
            ::unsetenv(name);
        std::fclose(commands_);
        ::waitpid(process_, nullptr, 0);
        std::fclose(answers_);
        std::filesystem::remove_all(config_);
    }
    Mock(const Mock&) = delete;
    Mock& operator=(const Mock&) = delete;

    State say(const std::string& words) {
        std::fprintf(commands_, "%s\n", words.c_str());
        std::fflush(commands_);
        State is;
        std::sscanf(line().c_str(), "playing=%d effects=%d gain=%d centring=%d files=%d played=%d", &is.playing,
                    &is.effects, &is.gain, &is.centring, &is.files, &is.played);
        return is;
    }
    State state() { return say("state"); }
    /// Within a thousandth of full strength.
    bool pushes_with(long wanted) { return std::abs(state().playing - wanted) <= 32; }

private:
    std::string line() {
        char text[512] = "";
        return std::fgets(text, sizeof text, answers_) ? text : "";
    }

    pid_t process_ = -1;
    std::FILE *commands_ = nullptr, *answers_ = nullptr;
    std::string folder_, host_;
    std::filesystem::path config_;
};

std::unique_ptr<hosted::HostedDevice> open_wheel() {
    auto device = hosted::open_placed({"wheel", "device 'hand'", {{"max_torque", "2 N m", {}}}, {}},
                                      [](const std::string& name) { return name; });
    device->prepare(1e-3);
    return std::unique_ptr<hosted::HostedDevice>(dynamic_cast<hosted::HostedDevice*>(device.release()));
}

/// Ticks that push to the right until the condition holds.
bool push_until(hosted::HostedDevice& device, const std::function<bool(const DeviceSample&)>& condition) {
    return tick(device, pushes, condition);
}

/// A preloaded library and a sanitizer's both want to be the first.
bool is_possible() {
    if (sanitized) skip("umockdev's preloaded library does not go with sanitizers");
    return !sanitized;
}

}  // namespace

TEST_CASE("a wheel is found by what the kernel says of it, turns the hand and takes a constant force", "[kernel]") {
    if (!is_possible()) return;
    Mock mock;
    {
        const auto wheel = open_wheel();
        CHECK(wheel->info().name == "Logitech G29 Driving Force Racing Wheel");
        CHECK(mock.state().centring == 0);
        CHECK(mock.state().gain == 0xFFFF);
        // The range of 540 degrees is that in /sys.
        mock.say("turn 49151");
        const double x = 0.14 * (49151.0 / 65535.0 - 0.5) * 540.0 * M_PI / 180.0;
        CHECK(push_until(*wheel,
                         [&](const DeviceSample& s) { return s.valid && std::abs(s.pose.position.x - x) < 1e-9; }));
        // An effect of this direction pushes to the left.
        CHECK(push_until(*wheel, [&](const DeviceSample&) { return mock.pushes_with(-level); }));
        CHECK(mock.state().effects == 1);
    }
    CHECK(mock.state().effects == 0);
    CHECK(mock.state().files == 0);
}

TEST_CASE("a wheel whose process is killed goes slack, also when the kernel leaves its effect", "[kernel]") {
    if (!is_possible()) return;
    for (const bool keeps : {false, true}) {
        CAPTURE(keeps);
        Mock mock;
        const auto wheel = open_wheel();
        if (keeps) mock.say("keep");
        REQUIRE(push_until(*wheel, [&](const DeviceSample&) { return mock.pushes_with(-level); }));
        ::kill(wheel->process(), SIGKILL);
        // An effect lasts for 100 ms. Nothing plays it again.
        CHECK(wait_until([&] { return mock.state().playing == 0; }, 1'000));
        CHECK(wait_until([&] { return mock.state().effects == (keeps ? 1 : 0); }));
        const int played = mock.state().played;
        CHECK_FALSE(wait_until([&] { return mock.state().playing != 0; }, 200));
        CHECK(mock.state().played == played);
    }
}

TEST_CASE("a wheel goes slack when its engine is killed, and centres as before", "[kernel]") {
    if (!is_possible()) return;
    Mock mock;
    const pid_t engine = ::fork();
    if (engine == 0) {
        try {
            const auto wheel = open_wheel();
            push_until(*wheel, [](const DeviceSample&) { return false; });
        } catch (...) {
        }
        ::_exit(0);
    }
    CHECK(wait_until([&] { return mock.pushes_with(-level); }));
    ::kill(engine, SIGKILL);
    ::waitpid(engine, nullptr, 0);
    CHECK(wait_until([&] { return mock.state().playing == 0; }, 1'000));
    CHECK(wait_until([&] { return mock.state().files == 0; }));
    CHECK(mock.state().effects == 0);
    CHECK(mock.state().centring == 13107);  // as /sys states it
}

TEST_CASE("a wheel that is unplugged is invalid, and pushes again when it is back", "[kernel]") {
    if (!is_possible()) return;
    Mock mock;
    const auto wheel = open_wheel();
    REQUIRE(push_until(*wheel, [&](const DeviceSample&) { return mock.pushes_with(-level); }));
    mock.say("unplug");
    CHECK(tick(*wheel, 0.0, [](const DeviceSample& s) { return !s.valid; }));
    CHECK(wait_until([&] { return mock.state().files == 0; }));
    mock.say("plug");
    CHECK(tick(*wheel, 0.0, [](const DeviceSample& s) { return s.valid; }));
    CHECK(push_until(*wheel, [&](const DeviceSample&) { return mock.pushes_with(-level); }));
}

#else

TEST_CASE("a wheel of umockdev", "[kernel]") { tactus::test::skip("umockdev or libumockdev-dev is missing"); }

#endif

// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/catalogue.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double period = 0.001;
const SourceLocation somewhere{"saw.toml", 4, 10};

std::unique_ptr<HapticDevice> open(
    std::string_view driver, std::vector<OptionText> given,
    const haptic::PathResolver& resolve = [](const std::string& name) { return name; }) {
    Options options("device 'hand'", std::move(given), {"saw.toml", 3, 1});
    return haptic::open_haptic_device(driver, somewhere, options, resolve);
}

/// A recording of a straight move of 20 mm along x in one second, 62.5 Hz.
struct Recording {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("tactus_replay_" + std::to_string(::getpid()) + ".csv");

    Recording() {
        std::ofstream file(path);
        file << "t_s,px_mm,py_mm,pz_mm,qx,qy,qz,qw\n";
        for (int i = 0; i <= 64; ++i) {
            const double u = i / 64.0;
            file << 10.0 + i * 0.016 << ',' << 20.0 * u * u * (3.0 - 2.0 * u) << ",5,0,0,0,0,1\n";
        }
    }
    ~Recording() { std::filesystem::remove(path); }
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;
};

DeviceSample run_patch(HapticDevice& device, double seconds, const Wrench& force = {}) {
    DeviceSample sample;
    for (int i = 0; i < static_cast<int>(std::lround(seconds / period)); ++i) {
        device.commit(force);
        sample = device.acquire(period);
    }
    return sample;
}

}  // namespace

TEST_CASE("the simulated hand presses 7 N into a wall and holds its trigger") {
    const auto device = open("simulated", {});
    device->prepare(period);
    Wrench force;
    double sum = 0.0;
    DeviceSample sample;
    for (int i = 0; i < 10'000; ++i) {
        sample = device->acquire(i == 0 ? 0.0 : period);
        REQUIRE(sample.valid);
        REQUIRE(sample.counter == i + 1);
        const double inside = -5e-3 - sample.pose.position.z;
        force.force.z = inside > 0.0 ? 800.0 * inside : 0.0;
        device->commit(force);
        if (i >= 5000) sum += force.force.z / 5000;
    }
    CHECK(sum == Approx(7.0).epsilon(0.1));
    CHECK((sample.buttons & button_trigger) != 0);
    CHECK(device->info().damping == Approx(15.0));
}

TEST_CASE("preparing a device again repeats it to the last bit") {
    const auto device = open("simulated", {{"tremor", "0.1 mm", {}}});
    device->prepare(period);
    const DeviceSample first = run_patch(*device, 2.0);
    device->prepare(period);
    const DeviceSample second = run_patch(*device, 2.0);
    CHECK(first.pose.position == second.pose.position);
    CHECK(first.twist.linear == second.twist.linear);
    CHECK(first.counter == second.counter);
}

TEST_CASE("options of the simulated hand change what it does") {
    const auto turned = open(
        "simulated",
        {{"feed_axis", "2 0 0", {}}, {"stroke_amplitude", "0 mm", {}}, {"tremor", "0 mm", {}}, {"turn", "90 deg", {}}});
    turned->prepare(period);
    const DeviceSample sample = run_patch(*turned, 1.0);
    CHECK(sample.pose.position.x > 5e-3);
    CHECK(std::abs(sample.pose.position.z) < 1e-9);
    CHECK(sample.pose.orientation.z == Approx(std::sqrt(0.5)));
    CHECK_THROWS_WITH(open("simulated", {{"feed_axis", "0 0 0", {"saw.toml", 6, 2}}}),
                      ContainsSubstring("saw.toml:6:2") && ContainsSubstring("direction"));
    CHECK_THROWS_WITH(open("simulated", {{"thrast", "3 N", {"saw.toml", 6, 2}}}),
                      ContainsSubstring("did you mean 'thrust'"));
}

TEST_CASE("a replayed hand follows its recording and yields to force") {
    const Recording recording;
    const auto device = open("replay", {{"file", recording.path.string(), {}}, {"place", "recorded", {}}});
    device->prepare(period);
    CHECK(device->acquire(0.0).pose.position.y == Approx(5e-3));
    const DeviceSample middle = run_patch(*device, 0.512);
    CHECK(middle.pose.position.x == Approx(10e-3).margin(0.5e-3));
    CHECK(middle.twist.linear.x == Approx(0.0293).margin(0.002));
    CHECK((middle.buttons & button_trigger) != 0);
    const DeviceSample pushed = run_patch(*device, 2.0, {{0.0, 0.0, 4.0}, {}});
    CHECK(pushed.pose.position.x == Approx(20e-3).margin(1e-5));
    CHECK(pushed.pose.position.z == Approx(4.0 / 800.0).margin(1e-5));
    CHECK((pushed.buttons & button_trigger) == 0);
}

TEST_CASE("the trigger of a replayed hand can start late or never") {
    const Recording recording;
    const OptionText file{"file", recording.path.string(), {}};
    const auto late = open("replay", {file, {"trigger", "from", {}}, {"trigger_from", "0.5 s", {}}});
    CHECK((run_patch(*late, 0.4).buttons & button_trigger) == 0);
    CHECK((run_patch(*late, 0.2).buttons & button_trigger) != 0);
    const auto never = open("replay", {file, {"trigger", "never", {}}});
    CHECK((run_patch(*never, 0.6).buttons & button_trigger) == 0);
    CHECK_THROWS_WITH(open("replay", {file, {"trigger_from", "1 s", {}}}), ContainsSubstring("trigger = \"from\""));
}

TEST_CASE("an unknown driver, a missing file name and a missing file are refused with what to do") {
    CHECK_THROWS_WITH(open("simulatd", {}), ContainsSubstring("saw.toml:4:10") &&
                                                ContainsSubstring("did you mean 'simulated'") &&
                                                ContainsSubstring("simulated, scripted, replay"));
    CHECK_THROWS_WITH(open("replay", {}), ContainsSubstring("saw.toml:3:1") && ContainsSubstring("'file'"));
    CHECK_THROWS_WITH(open("replay", {{"file", "/nowhere.csv", {}}}), ContainsSubstring("/nowhere.csv"));
    // The option that the recording cannot meet is named, with the file that says so.
    const Recording recording;
    CHECK_THROWS_WITH(open("replay", {{"file", recording.path.string(), {}}, {"tool", "Tool", {"--set replay.tool=Tool", 0, 0}}}),
                      ContainsSubstring("--set replay.tool=Tool: ") && ContainsSubstring("option 'tool'") &&
                          ContainsSubstring("there is no column Tool_px_mm"));
}

TEST_CASE("every driver has a name and a summary") {
    for (const haptic::HapticDriver& driver : haptic::haptic_drivers()) {
        CHECK_FALSE(driver.name.empty());
        CHECK_FALSE(driver.summary.empty());
    }
}

// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/scripted.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace tactus;

namespace {

std::unique_ptr<HapticDevice> open(const std::string& targets, const std::string& buttons = "") {
    Options options("device 'hand'",
                    {{"targets", targets, {"patch.toml", 7, 3}}, {"buttons", buttons, {"patch.toml", 7, 3}}});
    return haptic::open_scripted(options, [](const std::string& asset) { return std::filesystem::path(asset); });
}

}  // namespace

TEST_CASE("a scripted hand is at its targets at their times, and yields to force on the way") {
    const auto device = open("0 s: 0 0 5 mm; 1 s: 0 0 -10 mm, 0 0 30 deg; 2 s: 10 0 -10 mm");
    device->prepare(1e-3);
    DeviceSample sample;
    const auto until = [&](int ticks, const Wrench& force) {
        for (int n = 0; n < ticks; ++n) {
            sample = device->acquire(1e-3);
            device->commit(force);
        }
    };
    until(1, {});
    CHECK(sample.pose.position.z == Approx(5e-3).margin(1e-5));
    until(1000, {});
    CHECK(sample.pose.position.z == Approx(-10e-3).margin(0.2e-3));
    CHECK(2.0 * std::atan2(sample.pose.orientation.z, sample.pose.orientation.w) == Approx(0.5236).margin(0.03));
    until(3000, {});
    CHECK(sample.pose.position.x == Approx(10e-3).margin(1e-6));
    // 0.8 N against 800 N/m.
    until(3000, {{0.0, 0.0, 0.8}, {}});
    CHECK(sample.pose.position.z == Approx(-9e-3).margin(1e-5));
}

TEST_CASE("a scripted hand holds the buttons that it is told to, from the options or from a file") {
    const auto held = [](HapticDevice& device) {
        device.prepare(0.1);
        std::vector<std::uint32_t> all;
        for (int n = 0; n < 40; ++n) all.push_back(device.acquire(0.1).buttons);
        return std::vector{all[4], all[14], all[24], all[34]};
    };
    const std::vector<std::uint32_t> wanted{0u, button_trigger, button_trigger | 4u, 16u};
    CHECK(held(*open("0 s: 0 0 0 mm", "1 s: trigger; 2 s: trigger second; 3 s: fourth")) == wanted);
    const auto file = std::filesystem::temp_directory_path() / ("tactus_script_" + std::to_string(::getpid()));
    std::ofstream(file)
        << "# a hand\n0 s: 0 0 0 mm\n1 s: 0 0 1 mm | trigger\n2 s: 0 0 2 mm, 0 0 3 deg | trigger second\n"
           "3 s: 0 0 0 mm | fourth\n";
    Options options("device 'hand'", {{"file", file.string(), {"patch.toml", 7, 3}}});
    CHECK(held(*haptic::open_scripted(
              options, [](const std::string& asset) { return std::filesystem::path(asset); })) == wanted);
    std::filesystem::remove(file);
    for (const char* bad : {"1 s trigger", "1 s: triger", "2 s: trigger; 1 s:"}) {
        CAPTURE(bad);
        CHECK_THROWS_AS(open("0 s: 0 0 0 mm", bad), Error);
    }
}

TEST_CASE("a script that cannot be followed is refused with the place where it stands") {
    for (const char* bad : {"", "0 0 0 mm", "1 s: 0 0 mm", "1 s: 0 0 0", "1 s: 0 0 0 N", "1 s: 0 0 0 mm; 1 s: 0 0 1 mm",
                            "x s: 0 0 0 mm", "1 s: 0 0 0 mm, 1 2 3 mm"}) {
        CAPTURE(bad);
        try {
            open(bad);
            FAIL("accepted");
        } catch (const Error& error) {
            CHECK(error.where().line == 7);
        }
    }
}

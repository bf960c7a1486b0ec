// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/scripted.hpp"

#include "dsp/core/error.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace tactus;

namespace {

std::unique_ptr<HapticDevice> open(const std::string& targets) {
    Options options("device 'hand'", {{"targets", targets, {"patch.toml", 7, 3}}});
    return open_scripted(options);
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

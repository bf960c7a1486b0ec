// SPDX-License-Identifier: Apache-2.0
// Drivers under the attacks of `tactus bench peers`: what comes out is a pose or none, and no call waits.
#include "tools/bench/hostile_peer.hpp"

#include "devices/haptic/catalogue.hpp"
#include "dsp/core/clock.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

using namespace tactus;
using bench::Attack;
using bench::HostilePeer;
using bench::Line;

namespace {

constexpr std::int64_t ms = 1'000'000;

std::unique_ptr<HapticDevice> open(Line line, const HostilePeer& peer) {
    Options options("device 'hand'", {{"port", line == Line::serial ? peer.path() : std::to_string(peer.port()), {}}});
    const char* const driver = line == Line::web_socket    ? "haply"
                               : line == Line::openigtlink ? "openigtlink"
                                                           : "serial_board";
    auto device = haptic::open_haptic_device(driver, {}, options,
                                             [](const std::string& name) { return std::filesystem::path(name); });
    device->prepare(1e-3);
    return device;
}

}  // namespace

TEST_CASE("no attack on a driver's socket or line makes a call wait, or a pose that is none valid", "[kernel]") {
    ::setenv("XDG_CONFIG_HOME", "/nowhere", 1);
    for (const Line line : {Line::web_socket, Line::openigtlink, Line::serial})
        for (const Attack attack : {Attack::half, Attack::huge, Attack::slow, Attack::flood}) {
            CAPTURE(static_cast<int>(line), static_cast<int>(attack));
            HostilePeer peer(line, attack);
            auto device = open(line, peer);
            int valid = 0, broken = 0;
            std::int64_t next = steady_ns(), violations = 0;
            for (int tick = 0; tick < 400; ++tick) {
                DeviceSample sample;
                const RealtimeViolations seen = watch([&] {
                    sample = device->acquire(1e-3);
                    device->commit({{0.1, 0.0, 0.0}, {}});
                });
                violations += seen.describe() != "none";
                valid += sample.valid;
                broken += sample.valid && (!is_valid(sample.pose) || !is_finite(sample.twist.linear) ||
                                           glm::length(sample.pose.position) > 1.0);
                sleep_until(next += ms);
            }
            CHECK(violations == 0);
            CHECK(broken == 0);
            CHECK(valid > 0);  // before the attack
            CHECK(peer.bytes() > 0);
            const std::int64_t begin = steady_ns();
            device.reset();
            CHECK(steady_ns() - begin < 1000 * ms);
        }
    ::unsetenv("XDG_CONFIG_HOME");
}

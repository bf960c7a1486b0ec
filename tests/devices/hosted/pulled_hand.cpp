// SPDX-License-Identifier: Apache-2.0
// Where a person wants the hand, from a driver in a process of its own.
#include "devices/haptic/pulled_hand.hpp"

#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>

#include <cmath>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("where the sticks of a gamepad want the hand comes out of the process of its driver", "[kernel]") {
    const WatchedHost host;
    const std::string path = host.path() + "-pad";
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    const int end = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    REQUIRE(end >= 0);
    {
        auto opened = hosted::open_placed({"gamepad", "device 'pad'", {{"file", path, {}}}, {}},
                                          [](const std::string& name) { return name; });
        auto* const device = dynamic_cast<hosted::HostedDevice*>(opened.get());
        REQUIRE(device);
        device->prepare(1e-3);
        const auto link = device->pull();
        haptic::PulledHand told;
        std::uint64_t number = 0;
        REQUIRE(tick(*device, 0.0, [&](const DeviceSample&) { return link->read(told, number) && number != 0; }));
        CHECK(told.wanted.position == Vec3(0.0));
        input_event events[2]{};
        events[0].type = EV_ABS;
        events[0].code = ABS_X;
        events[0].value = 32767;
        events[1].type = EV_SYN;
        REQUIRE(::write(end, events, sizeof events) == sizeof events);
        CHECK(tick(*device, -6.0, [&](const DeviceSample& sample) {
            return link->read(told, number) && told.force.force.x == -6.0 &&
                   told.wanted.position.x - told.pose.position.x > 0.001 && sample.pose.position.x > 0.0;
        }));
        const RealtimeViolations seen = watch([&] {
            for (int n = 0; n < 100; ++n) device->acquire(1e-3);
        });
        CHECK(seen.describe() == "none");
    }
    ::close(end);
    CHECK(host.leaves_nothing());
}

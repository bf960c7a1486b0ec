// SPDX-License-Identifier: Apache-2.0
// What the window says for its hand while it draws.
#include "tools/window/hand/hand_pulse.hpp"

#include "devices/haptic/mouse.hpp"
#include "devices/haptic/window_hand.hpp"
#include "graph/node/options.hpp"
#include "tests/support/catch.hpp"

#include <atomic>
#include <chrono>
#include <thread>

using namespace tactus;

namespace {

constexpr std::int64_t millisecond = 1'000'000;
std::atomic<std::int64_t> clock_ns{0};
std::int64_t now_ns() { return clock_ns; }

/// The driver, and a window that draws.
struct PulseRig {
    haptic::WindowHand link;
    std::unique_ptr<HapticDevice> device;
    window::HandPulse pulse{link, now_ns};
    haptic::FeltHand felt;

    PulseRig() {
        clock_ns = 1'000'000'000;
        Options options("device 'mouse'", {});
        device = haptic::open_mouse(options, link, now_ns);
        device->prepare(1e-3);
        std::uint64_t number = 0;
        REQUIRE(link.felt.read(felt, number));
    }
    void say() { pulse.say({{}, button_trigger, clock_ns, 16 * millisecond, felt.run}); }
    /// Ticks of 1 ms with a pulse every 20 ms, until the hand is lost or so many are over. Returns their number.
    int ticks(int most) {
        for (int n = 1; n <= most; ++n) {
            clock_ns += millisecond;
            if (n % 20 == 0) pulse.repeat();
            if (device->acquire(1e-3).late) return n;
        }
        return most;
    }
};

constexpr int limit_ms = static_cast<int>(window::longest_step_ns / millisecond);
constexpr int silence_ms = static_cast<int>(haptic::longest_silence_of_window_ns / millisecond);

}  // namespace

TEST_CASE("a window that takes long to draw a picture keeps its hand and what it holds") {
    PulseRig rig;
    for (int picture = 0; picture < 5; ++picture) {
        rig.pulse.begin_picture();
        for (int step = 0; step < 3; ++step) {
            rig.say();
            REQUIRE(rig.ticks(limit_ms) == limit_ms);
            REQUIRE((rig.device->acquire(1e-3).buttons & button_trigger) != 0);
        }
        rig.pulse.end_picture();
    }
}

TEST_CASE("a window that hangs while it draws loses its hand within the limit, and for good") {
    PulseRig rig;
    rig.pulse.begin_picture();
    rig.say();
    const int lost = rig.ticks(5000);
    CHECK(lost >= limit_ms);
    CHECK(lost <= limit_ms + silence_ms + 1);
    for (int n = 0; n < 5000; ++n) {
        clock_ns += millisecond;
        rig.pulse.repeat();
        REQUIRE(rig.device->acquire(1e-3).late);
    }
    // Nor does its trigger stay held.
    CHECK((rig.device->acquire(1e-3).buttons & button_trigger) == 0);
}

TEST_CASE("a window that hangs between two pictures loses its hand after its silence") {
    PulseRig rig;
    rig.pulse.begin_picture();
    rig.say();
    rig.pulse.end_picture();
    CHECK(rig.ticks(5000) == silence_ms + 1);
}

TEST_CASE("nothing is said for a hand that is gone") {
    PulseRig rig;
    rig.pulse.begin_picture();
    rig.say();
    rig.pulse.forget();
    CHECK(rig.ticks(5000) == silence_ms + 1);
}

TEST_CASE("the window speaks by itself while its own thread is busy") {
    PulseRig rig;
    rig.pulse.begin_picture();
    rig.say();
    clock_ns += millisecond;
    haptic::WantedHand said;
    std::uint64_t number = 0;
    for (int n = 0; n < 1000 && said.at_ns != clock_ns; ++n) {
        rig.link.wanted.read(said, number);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    CHECK(said.at_ns == clock_ns);
}

// SPDX-License-Identifier: Apache-2.0
// A gamepad on an event device that says anything, until it is gone.
#include "devices/haptic/gamepad.hpp"

#include "dsp/core/error.hpp"
#include "tests/fuzz/devices/input_events.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

using namespace tactus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    test::InputEvents events(data + 1, size - 1);
    std::vector<OptionText> given;
    if (data[0] & 1) given.push_back({"file", "/dev/input/event7", {}});
    if (data[0] & 2) given.push_back({"rumble", "0 N", {}});
    Options options("device 'hand'", std::move(given));
    std::unique_ptr<HapticDevice> hand;
    try {
        hand = haptic::open_gamepad_of(events, options);
    } catch (const Error&) {
        return 0;
    }
    hand->prepare(1e-3);
    for (int i = 0;; ++i) {
        const DeviceSample sample = hand->acquire(1e-3);
        if (!sample.valid) return 0;  // the end of the input is a gamepad that was pulled out
        if (!std::isfinite(sample.pose.position.x) || !std::isfinite(sample.pose.orientation.w)) std::abort();
        hand->commit({{i % 2 == 0 ? 1e3 : -1.0, 0.0, 1.0}, {}});
        std::this_thread::yield();
    }
}

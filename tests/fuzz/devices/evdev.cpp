// SPDX-License-Identifier: Apache-2.0
// The driver of a wheel on an event device that says anything.
#include "devices/evdev/wheel.hpp"

#include "dsp/core/error.hpp"
#include "tests/fuzz/devices/input_events.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    test::InputEvents events(data + 1, size - 1);
    std::vector<OptionText> given;
    if (data[0] & 1) given.push_back({"file", "/dev/input/event7", {}});
    if (data[0] & 2) given.push_back({"moves", "rim", {}});
    Options options("device 'hand'", std::move(given));
    const auto wheel = evdev::make_wheel_of(events, options);
    const auto exchange = std::make_shared<driver::Exchange>();
    try {
        const driver::Opened opened = wheel->open(driver::OpenMode::run, exchange, [](const std::string&) {});
        exchange->begin({opened.info.max_force, 0.0}, 1e-6, 1e-6);
    } catch (const Error&) {
        return 0;
    }
    for (int i = 0; i < 100 && !events.is_over(); ++i) {
        exchange->commit({{i % 2 == 0 ? 1.0 : -1.0, 0.0, 1.0}, {}});
        if (!wheel->round(*exchange)) break;
        const DeviceSample sample = exchange->newest();
        if (sample.valid && !(std::isfinite(sample.pose.position.x) && std::isfinite(sample.pose.orientation.w)))
            std::abort();
    }
    wheel->close();
    return 0;
}

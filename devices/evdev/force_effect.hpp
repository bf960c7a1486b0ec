// SPDX-License-Identifier: Apache-2.0
// One effect of an event device: a constant force, or the vibration of a rumble motor. An effect lasts 100 ms and is
// renewed while it is wanted, so that a driver that hangs leaves no force. The kernel erases it when its file is
// closed. (docs.kernel.org/input/ff.html)
#pragma once

#include "devices/evdev/event_system.hpp"

#include <cstdint>

namespace tactus::evdev {

class ForceEffect {
public:
    static constexpr std::uint16_t lasts_ms = 100;
    static constexpr std::int64_t told_again_ns = 40'000'000;

    explicit ForceEffect(EventSystem& system) : system_(&system) {}

    /// Uploads the effect with zero strength. `type`: FF_CONSTANT or FF_RUMBLE. Returns false if the device rejects it
    /// (errno).
    bool begin(int file, std::uint16_t type) noexcept;
    /// Sets the strength, from -1 to 1, of a rumble from 0; positive pushes to the left. `now_ns` of any steady clock.
    /// Returns false if the device rejects it (errno); the current effect then ends by itself.
    bool give(double strength, std::int64_t now_ns) noexcept;
    /// Stops and erases the effect. The file must still be open, even if its device is gone.
    void end() noexcept;

private:
    bool upload() noexcept;
    bool play(int times) noexcept;
    void set(int level) noexcept;

    EventSystem* system_;
    int file_ = -1, level_ = 0;
    bool is_told_ = false;
    std::int64_t played_ns_ = 0;
    ff_effect effect_{};
};

}  // namespace tactus::evdev

// SPDX-License-Identifier: Apache-2.0
// Buttons in the order that patches use: trigger, second, third, fourth.
#pragma once

#include "graph/node/device.hpp"

#include <array>
#include <cstdint>

namespace tactus::driver {

/// Bits of DeviceSample::buttons by number; bit 1 is not a button.
inline constexpr std::array<std::uint32_t, 4> button_bits{button_trigger, 4u, 8u, 16u};

/// Converts a mask whose bit n is button n. Further buttons are ignored.
constexpr std::uint32_t buttons_of_mask(std::uint32_t mask) noexcept {
    std::uint32_t buttons = 0;
    for (std::size_t i = 0; i < button_bits.size(); ++i)
        if (mask >> i & 1u) buttons |= button_bits[i];
    return buttons;
}

}  // namespace tactus::driver

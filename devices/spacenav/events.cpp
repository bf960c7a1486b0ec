// SPDX-License-Identifier: Apache-2.0
#include "devices/spacenav/events.hpp"

#include <algorithm>
#include <cstring>

namespace tactus::spacenav {

namespace {

constexpr int most = 500;

}  // namespace

void EventReader::take(std::span<const std::uint8_t> bytes) noexcept {
    for (const std::uint8_t byte : bytes) {
        held_[size_++] = byte;
        if (size_ < size_of_event) continue;
        accept();
        size_ = 0;
    }
}

void EventReader::accept() noexcept {
    std::array<std::int32_t, 8> event{};
    std::memcpy(event.data(), held_.data(), size_of_event);
    if (event[0] == 0) {
        for (std::size_t i = 0; i < state_.deflection.size(); ++i)
            state_.deflection[i] = std::clamp(event[i + 1], -most, most);
    } else if ((event[0] == 1 || event[0] == 2) && event[1] >= 0 && event[1] < 32) {
        const std::uint32_t bit = 1u << event[1];
        state_.buttons = event[0] == 1 ? state_.buttons | bit : state_.buttons & ~bit;
    } else return;
    ++state_.events;
}

}  // namespace tactus::spacenav

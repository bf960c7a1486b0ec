// SPDX-License-Identifier: Apache-2.0
#include "devices/spacenav/events.hpp"

#include <algorithm>
#include <cstring>

namespace tactus::spacenav {

namespace {

constexpr int most = 500;
constexpr std::int32_t version_mask = 0xff;

}  // namespace

void EventReader::pass(std::int64_t elapsed_ns) noexcept {
    silence_ns_ = std::min(silence_ns_ + std::max<std::int64_t>(elapsed_ns, 0), longest_silence_ns);
    if (silence_ns_ == longest_silence_ns) state_.deflection = {};
}

void EventReader::take(std::span<const std::uint8_t> bytes) noexcept {
    for (const std::uint8_t byte : bytes) {
        held_[size_++] = byte;
        if (size_ == sizeof ask_for_devices) {
            std::int32_t answer = 0;
            std::memcpy(&answer, held_.data(), sizeof answer);
            if ((answer | version_mask) == (ask_for_devices | version_mask)) size_ = 0;
        }
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
    } else if (event[0] == 3) {
        // The event does not name the mouse that changed, so reset all.
        state_.deflection = {};
        state_.buttons = 0;
    } else return;
    silence_ns_ = 0;
    ++state_.events;
}

}  // namespace tactus::spacenav

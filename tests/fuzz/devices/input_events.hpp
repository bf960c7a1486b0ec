// SPDX-License-Identifier: Apache-2.0
// An event device that says anything: bits, ranges, names and events come from the input of a fuzzer.
#pragma once

#include "devices/evdev/event_system.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace tactus::test {

/// Each call takes the next bytes of the input; at its end the device is gone.
class InputEvents final : public evdev::EventSystem {
public:
    InputEvents(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    int open(const std::string&, int) noexcept override { return byte() == 255 ? fail(EACCES) : 7; }
    void close(int) noexcept override {}
    int control(int, unsigned long request, std::uintptr_t argument) noexcept override {
        const std::uint8_t how = byte();
        if (how == 254) return fail(EINVAL);
        if (how == 255 || is_over()) return fail(ENODEV);
        if (request == EVIOCSFF) {
            const auto* const effect = reinterpret_cast<const ff_effect*>(argument);
            if (effect->u.constant.level < -32767 || effect->replay.length == 0) std::abort();
            return 0;
        }
        if ((_IOC_DIR(request) & _IOC_READ) == 0) return 0;
        const std::size_t wanted = _IOC_SIZE(request);
        take(reinterpret_cast<void*>(argument), wanted);
        return static_cast<int>(wanted);
    }
    bool wait(int, int) noexcept override { return true; }
    ssize_t read(int, std::span<input_event> events) noexcept override {
        if (is_over()) return fail(ENODEV);
        const std::size_t count = byte() % 70;
        if (count == 0) return fail(EAGAIN);
        if (count > events.size()) return static_cast<ssize_t>(count % sizeof(input_event));  // a part of one
        for (input_event& event : events.first(count)) {
            event = {};
            event.type = byte() % 6;
            event.code = static_cast<std::uint16_t>(byte() | byte() << 8);
            take(&event.value, sizeof event.value);
        }
        return static_cast<ssize_t>(count * sizeof(input_event));
    }
    bool write(int, const input_event& event) noexcept override { return event.type == EV_FF && byte() != 255; }
    std::vector<std::string> devices() override { return std::vector<std::string>(byte() % 3, "/dev/input/event7"); }
    std::string attribute(const std::string&, const std::string&) override {
        std::string text(byte() % 12, '\0');
        take(text.data(), text.size());
        return text;
    }
    bool is_over() const { return at_ >= size_; }

private:
    int fail(int why) {
        errno = why;
        return -1;
    }
    std::uint8_t byte() { return is_over() ? 0 : data_[at_++]; }
    void take(void* into, std::size_t count) {
        const std::size_t there = std::min(count, size_ - at_);
        std::memset(into, 0, count);
        if (there > 0) std::memcpy(into, data_ + at_, there);
        at_ += there;
    }

    const std::uint8_t* data_;
    std::size_t size_, at_ = 0;
};

}  // namespace tactus::test

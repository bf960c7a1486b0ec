// SPDX-License-Identifier: Apache-2.0
// The system calls on Linux event devices (/dev/input/event*) that drivers make, replaceable by a fake kernel in tests.
#pragma once

#include <linux/input.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::evdev {

/// Like the system calls of these names: -1 and errno on failure. Any thread.
class EventSystem {
public:
    virtual ~EventSystem() = default;

    virtual int open(const std::string& path, int flags) noexcept = 0;
    virtual void close(int file) noexcept = 0;
    /// ioctl. `argument` is an address or a number, depending on the request.
    virtual int control(int file, unsigned long request, std::uintptr_t argument) noexcept = 0;
    /// Returns true if there is something to read, or if the device is lost.
    virtual bool wait(int file, int longest_ms) noexcept = 0;
    /// Returns the number of bytes read.
    virtual ssize_t read(int file, std::span<input_event> events) noexcept = 0;
    virtual bool write(int file, const input_event& event) noexcept = 0;

    /// Paths of all event devices, in order.
    virtual std::vector<std::string> devices() = 0;
    /// Returns the content of an attribute of the device in /sys, such as "range"; empty if there is none.
    virtual std::string attribute(const std::string& path, const std::string& name) = 0;
};

EventSystem& linux_events();

/// The bits of one kind of event that a device has (EVIOCGBIT), or of its pressed keys.
class Bits {
public:
    /// No bit is set if the ioctl fails.
    static Bits of_kind(EventSystem& system, int file, unsigned kind) noexcept;
    static Bits of_held_keys(EventSystem& system, int file) noexcept;
    bool operator[](unsigned code) const noexcept {
        return code / 8u < sizeof bytes_ && (bytes_[code / 8u] >> (code % 8u) & 1) != 0;
    }

private:
    unsigned char bytes_[KEY_MAX / 8 + 1] = {};
};

/// Returns false if EVIOCGABS fails.
bool ask_axis(EventSystem& system, int file, unsigned axis, input_absinfo& info) noexcept;

}  // namespace tactus::evdev

// SPDX-License-Identifier: Apache-2.0
#include "devices/evdev/event_system.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace tactus::evdev {

namespace {

namespace fs = std::filesystem;

class LinuxEvents final : public EventSystem {
public:
    int open(const std::string& path, int flags) noexcept override { return ::open(path.c_str(), flags | O_CLOEXEC); }
    void close(int file) noexcept override { ::close(file); }
    int control(int file, unsigned long request, std::uintptr_t argument) noexcept override {
        return ::ioctl(file, request, argument);
    }
    bool wait(int file, int longest_ms) noexcept override {
        pollfd waits{file, POLLIN, 0};
        return ::poll(&waits, 1, longest_ms) > 0;
    }
    ssize_t read(int file, std::span<input_event> events) noexcept override {
        return ::read(file, events.data(), events.size_bytes());
    }
    bool write(int file, const input_event& event) noexcept override {
        return ::write(file, &event, sizeof event) == static_cast<ssize_t>(sizeof event);
    }
    std::vector<std::string> devices() override {
        std::vector<fs::path> all;
        std::error_code failure;
        for (fs::directory_iterator at("/dev/input", failure), end; !failure && at != end; at.increment(failure))
            if (at->path().filename().string().starts_with("event")) all.push_back(at->path());
        std::ranges::sort(all);
        return {all.begin(), all.end()};
    }
    std::string attribute(const std::string& path, const std::string& name) override {
        // By its number, since /dev/input/by-id holds links. Above the event device is the input device, above that the
        // device at its bus.
        struct stat node{};
        if (::stat(path.c_str(), &node) != 0) return {};
        std::ifstream file(fs::path("/sys/dev/char") /
                           fmt::format("{}:{}/device/device", major(node.st_rdev), minor(node.st_rdev)) / name);
        std::string text;
        std::getline(file, text);
        return text;
    }
};

}  // namespace

EventSystem& linux_events() {
    static LinuxEvents system;
    return system;
}

Bits Bits::of_kind(EventSystem& system, int file, unsigned kind) noexcept {
    Bits bits;
    if (system.control(file, EVIOCGBIT(kind, sizeof bits.bytes_), reinterpret_cast<std::uintptr_t>(bits.bytes_)) < 0)
        return {};
    return bits;
}

Bits Bits::of_held_keys(EventSystem& system, int file) noexcept {
    Bits bits;
    if (system.control(file, EVIOCGKEY(sizeof bits.bytes_), reinterpret_cast<std::uintptr_t>(bits.bytes_)) < 0)
        return {};
    return bits;
}

bool ask_axis(EventSystem& system, int file, unsigned axis, input_absinfo& info) noexcept {
    return system.control(file, EVIOCGABS(axis), reinterpret_cast<std::uintptr_t>(&info)) >= 0;
}

}  // namespace tactus::evdev

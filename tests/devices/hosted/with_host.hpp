// SPDX-License-Identifier: Apache-2.0
// Devices in processes of their own, as tests open them, and what may not be left behind.
#pragma once

#include "devices/hosted/hosted_device.hpp"
#include "dsp/core/clock.hpp"
#include "tests/support/force_log.hpp"
#include "tests/support/places.hpp"

#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test {

inline constexpr std::int64_t ms = 1'000'000;

/// Until the condition holds, at most `longest_ms`.
inline bool wait_until(const std::function<bool()>& condition, std::int64_t longest_ms = 10'000) {
    const std::int64_t until = steady_ns() + longest_ms * ms;
    while (steady_ns() < until) {
        if (condition()) return true;
        sleep_until(steady_ns() + ms);
    }
    return condition();
}

inline std::vector<std::string> descriptors_of(const std::string& process) {
    std::vector<std::string> found;
    std::error_code gone;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/" + process + "/fd", gone)) {
        std::error_code closed;
        found.push_back(std::filesystem::read_symlink(entry.path(), closed).string());
    }
    return found;
}

/// The watched device of tests/support/fake_device_host.cpp. At the end, no process and no descriptor of it may be left.
class WatchedHost {
public:
    WatchedHost() : folder_(std::filesystem::temp_directory_path() / ("tactus_host_" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(folder_);
        std::filesystem::remove(path());
        log = std::make_unique<ForceLog>(path());
        ::setenv("TACTUS_DEVICE_HOST", fake_device_host().c_str(), 1);
        ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // processes without a parent come to this one
        before_ = descriptors_of("self").size();
    }
    ~WatchedHost() {
        ::unsetenv("TACTUS_DEVICE_HOST");
        std::filesystem::remove_all(folder_);
    }

    std::string path() const { return (folder_ / "log").string(); }
    hosted::DeviceRequest request(const std::string& fault = "none", int at = 0,
                                  const std::string& open_timeout = "10 s") const {
        return {"watched",
                "device 'hand'",
                {{"process", "true", {}},
                 {"log", path(), {}},
                 {"fault", fault, {}},
                 {"at", std::to_string(at), {}},
                 {"open_timeout", open_timeout, {}}},
                {}};
    }
    std::unique_ptr<hosted::HostedDevice> open(const std::string& fault = "none", int at = 0) const {
        auto device = hosted::open_placed(request(fault, at), [](const std::string& name) { return name; });
        device->prepare(1e-3);
        return std::unique_ptr<hosted::HostedDevice>(dynamic_cast<hosted::HostedDevice*>(device.release()));
    }
    /// No process, running or not yet waited for, and no descriptor more than before.
    bool leaves_nothing() const {
        const bool no_child = ::waitpid(-1, nullptr, WNOHANG) < 0;
        return no_child && descriptors_of("self").size() == before_;
    }

    std::unique_ptr<ForceLog> log;

private:
    std::filesystem::path folder_;
    std::size_t before_ = 0;
};

/// A tick a millisecond, of an engine that wants `force` N after it began small. Until the condition holds; true when it
/// did within 10 s.
inline bool tick(hosted::HostedDevice& device, double force, const std::function<bool(const DeviceSample&)>& until) {
    std::int64_t next = steady_ns();
    for (int i = 0; i < 10'000; ++i) {
        if (until(device.acquire(1e-3))) return true;
        device.commit({{i < 20 ? 0.0 : force, 0.0, 0.0}, {}});
        if (i % 20 == 0) device.service();
        sleep_until(next += ms);
    }
    return false;
}

}  // namespace tactus::test

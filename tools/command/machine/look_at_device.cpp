// SPDX-License-Identifier: Apache-2.0
#include "tools/command/machine/look_at_device.hpp"

#include "assets/file/json.hpp"
#include "devices/driver/confirmation.hpp"
#include "devices/haptic/catalogue.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

namespace tactus::command {

namespace {

using driver::ThreadedDevice;

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t looking_ns = 1'000 * ms, longest_wait_ns = 5'000 * ms;
constexpr double push_N = 0.4;

Options options_of(const DeviceLook& look) {
    std::vector<OptionText> given;
    for (const std::string& one : look.options) {
        const std::size_t equals = one.find('=');
        if (equals == std::string::npos || equals == 0)
            throw Error(fmt::format("a device option must be NAME=VALUE, not '{}'", one));
        given.push_back({one.substr(0, equals), one.substr(equals + 1), {}});
    }
    return Options(fmt::format("device '{}'", look.driver), std::move(given));
}

/// Ends the process without taking down what a driver that hangs still uses.
int leave(std::unique_ptr<ThreadedDevice> device, int code) {
    device.reset();
    if (driver::abandoned_threads() == 0) return code;
    std::fflush(nullptr);
    ::_exit(code);
}

file::Json json_of(const Vec3& v, double unit) { return file::Json::array({v.x * unit, v.y * unit, v.z * unit}); }

/// A tick a millisecond for a while. Returns the newest sample that was valid.
DeviceSample hold(ThreadedDevice& device, const Wrench& force, std::int64_t for_ns) {
    DeviceSample good;
    std::int64_t next = steady_ns();
    for (const std::int64_t end = next + for_ns; next < end;) {
        device.commit(force);
        if (const DeviceSample sample = device.acquire(1e-3); is_good(sample)) good = sample;
        sleep_until(next += ms);
    }
    return good;
}

bool wait_for_pose(ThreadedDevice& device) {
    for (const std::int64_t end = steady_ns() + longest_wait_ns; steady_ns() < end;)
        if (hold(device, {}, 10 * ms).valid) return true;
    return false;
}

int say_failure(const DeviceLook& look, const std::string& why, const std::vector<std::string>& steps) {
    if (look.json) fmt::print("{}\n", file::Json{{"driver", look.driver}, {"failed", why}, {"steps", steps}}.dump(2));
    else {
        for (std::size_t i = 0; i < steps.size(); ++i)
            fmt::print("{}  {}\n", i + 1 == steps.size() ? "FAILED" : "done  ", steps[i]);
        fmt::print("{}: {}\n", look.driver, why);
    }
    return answer_is_no;
}

void print(const DeviceLook& look, const ThreadedDevice& device, const DeviceSample& sample, double rate) {
    const driver::Opened& opened = device.opened();
    const bool confirmed = driver::is_confirmed(look.driver, opened);
    const Quat& q = sample.pose.orientation;
    if (look.json) {
        fmt::print("{}\n", file::Json{{"driver", look.driver},
                                      {"name", opened.info.name},
                                      {"serial", opened.serial},
                                      {"versions", opened.versions},
                                      {"steps", device.steps()},
                                      {"valid", sample.valid},
                                      {"position_mm", json_of(sample.pose.position, 1e3)},
                                      {"orientation_wxyz", file::Json::array({q.w, q.x, q.y, q.z})},
                                      {"velocity_mm_s", json_of(sample.twist.linear, 1e3)},
                                      {"buttons", static_cast<unsigned>(sample.buttons)},
                                      {"rate_hz", rate},
                                      {"max_force_N", opened.info.max_force},
                                      {"directions_confirmed", confirmed},
                                      {"tested_on_hardware", false}}
                               .dump(2));
        return;
    }
    fmt::print("{}, serial number {}\n", opened.info.name, opened.serial.empty() ? "not stated" : opened.serial);
    for (const std::string& version : opened.versions) fmt::print("  {}\n", version);
    for (const std::string& step : device.steps()) fmt::print("  done: {}\n", step);
    if (sample.valid) {
        const Vec3 p = sample.pose.position * 1e3;
        fmt::print(
            "  position {:.3f}, {:.3f}, {:.3f} mm (right, away, up); orientation {:.4f} {:.4f} {:.4f} {:.4f} (w x "
            "y z)\n",
            p.x, p.y, p.z, q.w, q.x, q.y, q.z);
    } else fmt::print("  no valid pose: is the device calibrated?\n");
    fmt::print("  buttons {:#x}, {:.0f} samples/s, largest force {:.2f} N\n", sample.buttons, rate,
               opened.info.max_force);
    if (!(opened.info.max_force > 0.0)) {
        fmt::print("  this driver is untested on hardware; the device has no motors\n");
        return;
    }
    fmt::print("  this driver is untested on hardware; push directions of this device are {}\n",
               confirmed ? "confirmed" : fmt::format("not confirmed: tactus devices --verify {}", look.driver));
}

struct Push {
    Vec3 along;
    const char* word;
};
constexpr const char* words[] = {"right", "left", "away", "towards", "up", "down"};

/// The answer, or "" at the end of the input.
std::string ask() {
    for (;;) {
        fmt::print("Which way did it push? right, left, away, towards, up, down, none: ");
        std::fflush(stdout);
        std::string answer;
        if (!std::getline(std::cin, answer)) return {};
        for (const char* word : words)
            if (answer == word) return answer;
        if (answer == "none") return answer;
    }
}

}  // namespace

namespace {

/// Before a driver's thread begins: vendors' libraries ask for the user's language and then misread their own files.
void speak_c() { ::setenv("LC_ALL", "C", 1); }

}  // namespace

int probe_device(const DeviceLook& look) {
    speak_c();
    Options options = options_of(look);
    std::unique_ptr<ThreadedDevice> device;
    try {
        device = haptic::open_to_look(look.driver, options, driver::OpenMode::reading);
    } catch (const driver::OpenError& error) {
        return leave(nullptr, say_failure(look, error.what(), error.steps));
    }
    wait_for_pose(*device);
    const std::int64_t before = device->published(), begin = steady_ns();
    const DeviceSample sample = hold(*device, {}, looking_ns);
    const double rate =
        static_cast<double>(device->published() - before) * 1e9 / static_cast<double>(steady_ns() - begin);
    print(look, *device, sample, rate);
    return leave(std::move(device), sample.valid ? done : answer_is_no);
}

int verify_device(const DeviceLook& look) {
    speak_c();
    Options options = options_of(look);
    std::unique_ptr<ThreadedDevice> device;
    try {
        device = haptic::open_to_look(look.driver, options, driver::OpenMode::run);
    } catch (const driver::OpenError& error) {
        return leave(nullptr, say_failure(look, error.what(), error.steps));
    }
    const driver::Opened opened = device->opened();
    if (opened.info.without_motors) {
        fmt::print("{} has no motors: there is nothing to confirm\n", opened.info.name);
        return leave(std::move(device), done);
    }
    if (opened.serial.empty()) {
        fmt::print(
            "{} states no serial number, under which the answers could be kept: give one with --option "
            "serial=NAME, and in the patch\n",
            opened.info.name);
        return leave(std::move(device), answer_is_no);
    }
    if (!wait_for_pose(*device)) {
        fmt::print("{} has no valid pose; calibrate it first: tactus devices --probe {}\n", opened.info.name,
                   look.driver);
        return leave(std::move(device), answer_is_no);
    }
    fmt::print(
        "{}, serial number {}. Hold the handle lightly, away from its stops. It pushes with {:.1f} N for a "
        "second each time.\n",
        opened.info.name, opened.serial, push_N);
    const Push pushes[] = {{{1.0, 0.0, 0.0}, "right"}, {{0.0, -1.0, 0.0}, "towards"}, {{0.0, 0.0, 1.0}, "up"}};
    for (int i = 0; i < opened.axes; ++i) {
        hold(*device, {}, 50 * ms);
        const bool was_there = hold(*device, {pushes[i].along * push_N, {}}, 1'000 * ms).valid;
        hold(*device, {}, 20 * ms);
        if (!was_there) {
            fmt::print("the device was lost\n");
            return leave(std::move(device), answer_is_no);
        }
        const std::string answer = ask();
        if (answer == pushes[i].word) continue;
        driver::forget(look.driver, opened);
        fmt::print(
            "\nnot confirmed: it should have pushed to '{}'. It stays capped at {:.1f} N; please report this "
            "with the text of 'tactus devices --probe {}'\n",
            pushes[i].word, driver::unconfirmed_force, look.driver);
        return leave(std::move(device), answer_is_no);
    }
    driver::confirm(look.driver, opened);
    fmt::print("confirmed and kept in {}: from now on up to {:.2f} N\n", driver::confirmations_file().string(),
               opened.info.max_force);
    return leave(std::move(device), done);
}

}  // namespace tactus::command

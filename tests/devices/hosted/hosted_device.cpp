// SPDX-License-Identifier: Apache-2.0
// A driver in a process of its own that fails in every way, seen from the engine.
#include "devices/hosted/hosted_device.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cmath>
#include <fstream>

using namespace tactus;
using namespace tactus::test;

namespace {

const haptic::PathResolver as_named = [](const std::string& name) { return std::filesystem::path(name); };

std::string error_of(const std::function<void()>& code) {
    try {
        code();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

hosted::DeviceRequest simulated(std::vector<OptionText> settings) {
    return {"simulated", "device 'hand'", std::move(settings), {"p.toml", 7, 1}};
}

}  // namespace

TEST_CASE("a driver in a process of its own gives samples and takes forces", "[live]") {
    const WatchedHost host;
    {
        const auto device = host.open();
        CHECK(device->info().name == "watched");
        CHECK(device->info().max_force == 20.0);
        CHECK(device->info().actuates_torque);
        CHECK(::getsid(device->process()) == device->process());
        CHECK(tick(*device, 4.0, [&](const DeviceSample&) { return host.log->last() == 4.0; }));
        const DeviceSample sample = device->acquire(1e-3);
        CHECK(sample.valid);
        CHECK(sample.counter > 0);
        CHECK(device->service().empty());
    }
    CHECK(host.log->is_closed());
    CHECK(host.log->last() == 0.0);
    CHECK(host.leaves_nothing());
}

TEST_CASE("what a device states of its delay has that of its process in it, once") {
    const WatchedHost host;
    const auto device = host.open();
    // The process looks four times in a tick, and both a sample and a force wait for it once.
    const double own = device->info().delay - 0.5e-3;
    CHECK(own > -1e-12);
    device->prepare(2e-3);
    CHECK(device->info().delay == Approx(own + 1e-3).margin(1e-12));
}

TEST_CASE("a hand at the window has no process of its own") {
    const hosted::DeviceRequest request{
        "mouse", "device 'm'", {{"process", "true", {"p.toml", 9, 1}}}, {"p.toml", 7, 1}};
    CHECK(error_of([&] { hosted::open_placed(request, as_named); }).find("p.toml:9") == 0);
}

TEST_CASE("acquire and commit of a device with a process of its own call no system and allocate nothing") {
    const WatchedHost host;
    const auto device = host.open();
    device->acquire(0.0);
    const RealtimeViolations seen = watch([&] {
        for (int i = 0; i < 100; ++i) {
            device->acquire(1e-3);
            device->commit({});
            device->drive({});
        }
    });
    CHECK(seen.describe() == "none");
}

TEST_CASE("a device's process has no descriptor of the engine") {
    const WatchedHost host;
    const std::string secret = host.path() + "-open";
    const int file = ::open(secret.c_str(), O_CREAT | O_RDWR, 0600);  // a library may forget to close it on exec
    {
        const auto device = host.open();
        const auto theirs = descriptors_of(std::to_string(device->process()));
        CHECK(theirs.size() >= 5);
        CHECK(std::ranges::find(theirs, secret) == theirs.end());
    }
    ::close(file);
}

TEST_CASE("a sample that is no pose is not valid, and a force that is no number is none", "[kernel]") {
    const WatchedHost host;
    const auto device = host.open("no pose", 300);
    CHECK(tick(*device, 4.0, [&](const DeviceSample&) { return host.log->last() == 4.0; }));
    CHECK(tick(*device, 4.0, [&](const DeviceSample& sample) { return !sample.valid; }));
    const auto commit_nan = [&] {
        device->commit({{std::nan(""), 0.0, 0.0}, {}});
        return host.log->last() == 0.0;
    };
    CHECK(wait_until(commit_nan));
    const std::int64_t from = boot_ns();
    CHECK_FALSE(wait_until([&] { return !commit_nan(); }, 50));
    CHECK(host.log->max_after(from) == 0.0);
    for (const ForceLog::Entry& entry : host.log->entries()) REQUIRE(std::isfinite(entry.force));
}

TEST_CASE("the error of a driver in a process of its own is that of the driver") {
    const WatchedHost host;
    ::setenv("TACTUS_DEVICE_HOST", (std::filesystem::path(command()).parent_path() / "tactus-device-host").c_str(), 1);
    for (const OptionText& wrong : {OptionText{"mas", "1 kg", {"p.toml", 9, 1}},
                                    {"mass", "1 m", {"p.toml", 10, 1}},
                                    {"mass", "90 kg", {"p.toml", 10, 1}}}) {
        const auto here = error_of([&] { hosted::open_here(simulated({wrong}), as_named); });
        const auto there = error_of(
            [&] { hosted::open_placed(simulated({wrong, {"process", "true", {"p.toml", 11, 1}}}), as_named); });
        CHECK(here == there);
        CHECK(here.starts_with("p.toml:"));
    }
    const hosted::DeviceRequest unknown{"none such", "device 'hand'", {{"process", "true", {}}}, {"p.toml", 7, 1}};
    CHECK(
        error_of([&] { hosted::open_placed(unknown, as_named); }).starts_with("p.toml:7:1: there is no haptic driver"));
    CHECK(host.leaves_nothing());
}

TEST_CASE("a driver in a process of its own finds the files of its patch") {
    const WatchedHost host;
    ::setenv("TACTUS_DEVICE_HOST", (std::filesystem::path(command()).parent_path() / "tactus-device-host").c_str(), 1);
    const std::string script = host.path() + "-script";
    std::ofstream(script) << "0 s: 30 0 0 mm\n1 s: 30 0 0 mm\n";
    const hosted::DeviceRequest request{
        "scripted", "device 'hand'", {{"process", "true", {}}, {"file", "moves", {}}}, {}};
    {
        const auto device = hosted::open_placed(request, [&](const std::string& name) {
            CHECK(name == "moves");
            return std::filesystem::path(script);
        });
        device->prepare(1e-3);
        CHECK(device->acquire(0.0).pose.position.x == Approx(30e-3));
    }
    CHECK(error_of([&] {
              hosted::open_placed(request, [](const std::string&) -> std::filesystem::path {
                  throw Error({"p.toml", 3, 1}, "no asset of that name");
              });
          }) == "p.toml:3:1: no asset of that name");
    CHECK(host.leaves_nothing());
}

TEST_CASE("a driver that never opens, prepares or states nonsense is one clear error", "[live]") {
    const WatchedHost host;
    const std::int64_t begin = steady_ns();
    CHECK(error_of([&] {
              hosted::open_placed(host.request("hang in open", 0, "0.3 s"), as_named);
          }).starts_with("device 'hand': the driver did not answer within 0.3 s"));
    CHECK(error_of([&] {
              hosted::open_placed(host.request("hang in prepare", 0, "0.3 s"), as_named)->prepare(1e-3);
          }).starts_with("device 'hand': the driver did not answer within 0.3 s"));
    CHECK(error_of([&] { host.open("fail in prepare"); }) == "the motors are cold");
    CHECK(error_of([&] { host.open("endless limit"); }).find("states inf as a limit") != std::string::npos);
    ::setenv("TACTUS_DEVICE_HOST", "/none/such", 1);
    CHECK(error_of([&] { host.open(); }).find("/none/such: a process for a device cannot be started") == 0);
    ::setenv("TACTUS_DEVICE_HOST", "/bin/false", 1);
    CHECK(error_of([&] { host.open(); }) == "device 'hand': its process ended with exit code 1");
    CHECK(steady_ns() - begin < 8'000 * ms);
    CHECK(host.leaves_nothing());
}

TEST_CASE("a driver that never returns makes samples invalid and is killed, not waited for", "[live]") {
    for (const std::string fault : {"hang in acquire", "hang in commit", "hang in close"}) {
        CAPTURE(fault);
        const WatchedHost host;
        auto device = host.open(fault, 300);
        if (fault != "hang in close") {
            CHECK(tick(*device, 4.0, [&](const DeviceSample& sample) { return !sample.valid; }));
            CHECK(tick(*device, 0.0, [&](const DeviceSample&) { return !device->loss().empty(); }));
            CHECK(device->loss() == "its driver did not return for 500 ms; its process was killed");
        } else CHECK(tick(*device, 4.0, [&](const DeviceSample&) { return host.log->last() == 4.0; }));
        const std::int64_t begin = steady_ns();
        device.reset();
        CHECK(steady_ns() - begin < 400 * ms);
        CHECK(host.leaves_nothing());
    }
}

TEST_CASE("a process of a device that is killed, ended or stopped is named", "[live]") {
    for (const auto& [signal, said] : {std::pair{SIGKILL, "its process was killed by signal 9"},
                                       {SIGTERM, "its process ended: it got a signal to end"},
                                       {SIGSTOP, "its driver did not return for 500 ms; its process was killed"}}) {
        CAPTURE(signal);
        const WatchedHost host;
        auto device = host.open();
        CHECK(tick(*device, 4.0, [&](const DeviceSample&) { return host.log->last() == 4.0; }));
        ::kill(device->process(), signal);
        CHECK(tick(*device, 4.0, [&](const DeviceSample& sample) { return !sample.valid; }));
        CHECK(tick(*device, 4.0, [&](const DeviceSample&) { return !device->loss().empty(); }));
        CHECK(device->loss() == said);
        CHECK(host.log->is_closed() == (signal == SIGTERM));
        if (signal == SIGTERM) CHECK(host.log->last() == 0.0);
        const std::int64_t begin = steady_ns();
        device.reset();
        CHECK(steady_ns() - begin < 400 * ms);
        CHECK(host.leaves_nothing());
    }
}

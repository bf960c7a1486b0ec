// SPDX-License-Identifier: Apache-2.0
// What a process of its own costs a device: from a commit of the engine to the first sample that knows its force, beside
// the same driver inside the engine.
#include "assets/file/json.hpp"
#include "devices/hosted/hosted_device.hpp"
#include "dsp/core/clock.hpp"
#include "tools/bench/bench.hpp"

#include <fmt/format.h>

#include <pthread.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

struct DeviceBenchChoice {
    double seconds = 5.0, rate = 1000.0, process_rate = 0.0;
    bool json = false;
};

Json quantiles_us(std::vector<std::int64_t> times) {
    std::ranges::sort(times);
    const auto at = [&](double q) {
        return 1e-3 * static_cast<double>(times[static_cast<std::size_t>(q * static_cast<double>(times.size() - 1))]);
    };
    return {{"p50", at(0.5)}, {"p99", at(0.99)}, {"max", at(1.0)}};
}

hosted::DeviceRequest request_of(const DeviceBenchChoice& choice, bool own_process) {
    hosted::DeviceRequest request{"simulated", "device 'bench'", {{"process", own_process ? "true" : "false", {}}}, {}};
    if (choice.process_rate > 0.0)
        request.settings.push_back({"process_rate", fmt::format("{} Hz", choice.process_rate), {}});
    return request;
}

std::unique_ptr<HapticDevice> open(const DeviceBenchChoice& choice, bool own_process) {
    auto device = hosted::open_placed(request_of(choice, own_process),
                                      [](const std::string& name) { return std::filesystem::path(name); });
    device->prepare(1.0 / choice.rate);
    return device;
}

/// Calls one(n) once per tick.
template <class One>
void ticks(const DeviceBenchChoice& choice, One&& one) {
    const auto count = static_cast<std::int64_t>(choice.seconds * choice.rate);
    std::int64_t next = steady_ns();
    for (std::int64_t n = 0; n < count; ++n) {
        one();
        next = std::max<std::int64_t>(next + std::llround(1e9 / choice.rate), steady_ns());
        sleep_until(next);
    }
}

/// Of acquire and commit, as a tick calls them.
Json measure_calls(const DeviceBenchChoice& choice, HapticDevice& device) {
    std::vector<std::int64_t> calls;
    ticks(choice, [&] {
        const std::int64_t begin = steady_ns();
        device.acquire(1.0 / choice.rate);
        device.commit({});
        calls.push_back(steady_ns() - begin);
    });
    return quantiles_us(std::move(calls));
}

int bench_device(const DeviceBenchChoice& choice) {
    ::mlockall(MCL_CURRENT | MCL_FUTURE);
    sched_param parameters{};
    parameters.sched_priority = 60;
    const bool is_real_time = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters) == 0;
    const auto inside = open(choice, false);
    const Json inside_us = measure_calls(choice, *inside);
    const auto opened = open(choice, true);
    auto& device = dynamic_cast<hosted::HostedDevice&>(*opened);
    const Json calls_us = measure_calls(choice, device);
    std::vector<std::int64_t> round_trips;
    std::int64_t lost = 0;
    const std::int64_t longest_ns = std::llround(1e9 / choice.rate);
    double phase = 0.0;
    ticks(choice, [&] {
        // Both keep one clock, so that a run has one phase between them; here all are met alike (golden ratio).
        phase = std::fmod(phase + 0.6180339887, 1.0);
        const std::int64_t from = steady_ns() + std::llround(0.25e9 * phase / choice.rate);
        while (steady_ns() < from) {
        }
        const std::int64_t begin = boot_ns();
        device.commit({});
        std::int64_t now = begin;
        while (device.answered_ns() < begin && now - begin < longest_ns) {
            device.acquire(0.0);
            now = boot_ns();
        }
        if (device.answered_ns() < begin) ++lost;
        else round_trips.push_back(now - begin);
    });
    if (round_trips.empty()) throw Error("the device's process never answered within a tick");
    const Json json{{"rate_hz", choice.rate},
                    {"real_time", is_real_time},
                    {"ticks", round_trips.size()},
                    {"later_than_a_tick", lost},
                    {"round_trip_us", quantiles_us(std::move(round_trips))},
                    {"acquire_and_commit_us", calls_us},
                    {"inside_the_engine_us", inside_us}};
    if (choice.json) {
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    const auto line = [&](const char* what, const Json& us) {
        fmt::print("{:<44} p50 {:8.2f} us   p99 {:8.2f} us   max {:8.1f} us\n", what, us["p50"].get<double>(),
                   us["p99"].get<double>(), us["max"].get<double>());
    };
    fmt::print("simulated device at {:.4g} Hz, {} ticks{}\n", choice.rate, json["ticks"].get<std::size_t>(),
               is_real_time ? "" : ", without real-time priority");
    line("from a commit to a sample with its force", json["round_trip_us"]);
    line("acquire and commit, process of its own", calls_us);
    line("acquire and commit, inside the engine", inside_us);
    if (lost > 0) fmt::print("{} round trips took longer than a tick\n", lost);
    return done;
}

}  // namespace

Verb device_verb() {
    return {
        "device", "time of a force to a device with a process of its own and back, beside the device in the engine",
        [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<DeviceBenchChoice>();
            verb.add("--seconds", choice->seconds, "length of each measurement, s")
                .unit("s")
                .shows_default()
                .range(0.1, 3600.0);
            verb.add("--rate", choice->rate, "ticks of the engine, Hz").unit("Hz").shows_default().range(10.0, 8000.0);
            verb.add("--process-rate", choice->process_rate,
                     "rounds of the device's process, Hz (default: four times the ticks)")
                .unit("Hz")
                .range(100.0, 20000.0);
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_device(*choice); };
        }};
}

}  // namespace tactus::bench

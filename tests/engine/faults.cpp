// SPDX-License-Identifier: Apache-2.0
// Planted faults, and what would have reached the hand.
#include "tests/engine/chaos.hpp"
#include "tests/engine/played_device.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double max_force = 6.0, max_torque = 0.3;   // N, N·m
constexpr double slew = 1.0, torque_slew = 0.05;      // per ms
constexpr double rest = 0.0, pressed = -4e-3;         // m: no force, 4 N

/// Rests, then presses to 4 mm depth within 100 ms, and stays.
DeviceSample pressing(std::int64_t count) {
    DeviceSample sample;
    sample.pose.position.z = std::clamp(static_cast<double>(count - 20) / 100.0, 0.0, 1.0) * (pressed - rest);
    sample.counter = count;
    sample.valid = true;
    return sample;
}

std::string patch_text(const std::string& fault, int at, const std::string& stall = "0 ms",
                       const std::string& more = "") {
    return PatchText{{{"hand", "device_input", "1 kHz", {{"device", "faulty"}}},
                      {"plant", "planted", "1 kHz", {{"fault", fault}, {"at", std::to_string(at)}, {"stall", stall}}},
                      {"out",
                       "device_output",
                       "1 kHz",
                       {{"device", "faulty"},
                        {"max_force", "6 N"},
                        {"max_torque", "0.3 N m"},
                        {"slew", "1 N/ms"},
                        {"torque_slew", "0.05 N m/ms"}}},
                      {"near", "chaos", "1 kHz", {}},
                      {"other", "chaos", "200 Hz", {}}},
                     {"hand.pose -> plant.pose", "plant.wrench -> out.wrench", "near.out -> other.in as linear",
                      "other.out -> near.in"},
                     "[devices.faulty]\ndriver = \"faulty\"\n" + more}
        .toml();
}

/// One force that reached the hand.
struct Given {
    Wrench wrench;
    std::thread::id by;
};

struct Outcome {
    std::vector<Given> given;
    std::vector<io::DeviceFault> faults;
    std::int64_t other_ran = 0, other_skipped = 0;
};

Outcome run_patch(const std::string& toml, double length, const std::function<DeviceSample(std::int64_t)>& hand,
                  const std::optional<std::filesystem::path>& live_log = {}) {
    Outcome outcome;
    outcome.given.reserve(100'000);
    Performance performance;
    performance.acquire = [&](std::int64_t count, double, const Wrench&) { return hand(count); };
    // Nothing else keeps the two threads apart here: that is the guard's promise.
    performance.commit = [&](const Wrench& w) { outcome.given.push_back({w, std::this_thread::get_id()}); };
    play_as("faulty", performance);
    run::EngineOptions options;
    options.seconds = length;
    options.live = live_log.has_value();
    run::Engine engine(compile_text(toml), options);
    if (live_log) engine.run_live({.dilate = 1.0, .log = live_log, .stop = nullptr, .watch = {}});
    else engine.render(1);
    for (const auto& slot : engine.host().devices) outcome.faults = slot->guard.faults();
    for (const auto& group : engine.groups())
        if (group->plan->name == "200 Hz") {
            outcome.other_ran = group->telemetry.ticks;
            outcome.other_skipped = group->telemetry.skipped;
        }
    if (!live_log) return outcome;
    const take::TimingLog log = take::TimingLog::load(*live_log);
    run::EngineOptions again;
    again.seconds = length;
    again.replay = &log;
    run::Engine replay(compile_text(toml), again);
    replay.render(1);
    CHECK(replay.port_hashes() == engine.port_hashes());
    std::filesystem::remove(*live_log);
    return outcome;
}

double force_at(const Outcome& o, std::size_t i) { return glm::length(o.given[i].wrench.force); }

/// Every force is finite, within its limit, and no further from the one before than slew or fade allow.
void check_bounds(const Outcome& o) {
    double most = 0.0, peak_torque = 0.0, step = 0.0, torque_step = 0.0;
    bool finite = true;
    for (std::size_t i = 0; i < o.given.size(); ++i) {
        const Wrench& w = o.given[i].wrench;
        finite = finite && is_finite(w);
        most = std::max(most, glm::length(w.force));
        peak_torque = std::max(peak_torque, glm::length(w.torque));
        const Wrench before = i > 0 ? o.given[i - 1].wrench : Wrench{};
        step = std::max(step, glm::length(w.force - before.force));
        torque_step = std::max(torque_step, glm::length(w.torque - before.torque));
    }
    CHECK(finite);
    CHECK(most <= max_force * (1.0 + 1e-12));
    CHECK(peak_torque <= max_torque * (1.0 + 1e-12));
    CHECK(step <= slew * (1.0 + 1e-9));
    CHECK(torque_step <= torque_slew * (1.0 + 1e-9));
}

const auto plain_hand = [](std::int64_t count) { return pressing(count); };

}  // namespace

TEST_CASE("without a fault the hand feels the spring, and nothing is told", "[virtual]") {
    const VirtualClock clock;
    const Outcome o = run_patch(patch_text("none", 0), 1.0, plain_hand);
    check_bounds(o);
    CHECK(force_at(o, 900) == Approx(4.0));
    CHECK(o.faults.empty());
}

TEST_CASE("a force that is not a number, or infinite, fades to zero within 10 ms and never returns", "[virtual]") {
    const VirtualClock clock;
    for (const std::string fault : {"nan", "inf"}) {
        const Outcome o = run_patch(patch_text(fault, 500), 3.0, plain_hand);
        INFO(fault);
        check_bounds(o);
        CHECK(force_at(o, 499) == Approx(4.0));
        for (std::size_t i = 509; i < o.given.size(); ++i) REQUIRE(force_at(o, i) == 0.0);
        REQUIRE(o.faults.size() == 1);
        CHECK(o.faults[0].reason == control::Fault::not_finite);
        CHECK(o.faults[0].tick == 500);
        CHECK(o.faults[0].force_N == Approx(4.0));
    }
}

TEST_CASE("a driver whose sample counter stops is given up after 10 ticks, and without force 10 ms later",
          "[virtual]") {
    const VirtualClock clock;
    const Outcome o = run_patch(patch_text("none", 0), 3.0, [](std::int64_t count) {
        DeviceSample sample = pressing(count);
        sample.counter = count < 500 || count > 700 ? count : 500;
        // It comes back pressing; only once it has let go do forces ramp in again.
        if (count > 2000) sample.pose.position.z = count < 2300 ? rest : pressing(count - 2300).pose.position.z;
        return sample;
    });
    check_bounds(o);
    CHECK(force_at(o, 505) == Approx(4.0));
    for (std::size_t i = 520; i < 2295; ++i) REQUIRE(force_at(o, i) == 0.0);
    CHECK(force_at(o, 2900) == Approx(4.0));
    REQUIRE(o.faults.size() == 1);
    CHECK(o.faults[0].reason == control::Fault::stale_input);
}

TEST_CASE("an invalid sample fades the force at once", "[virtual]") {
    const VirtualClock clock;
    const Outcome o = run_patch(patch_text("none", 0), 1.0, [](std::int64_t count) {
        DeviceSample sample = pressing(count);
        sample.valid = count != 500;
        return sample;
    });
    check_bounds(o);
    for (std::size_t i = 510; i < o.given.size(); ++i) REQUIRE(force_at(o, i) == 0.0);
    REQUIRE(o.faults.size() == 1);
    CHECK(o.faults[0].reason == control::Fault::invalid_input);
}

TEST_CASE("a force spike, a jump of 15 mm and a flip of 180 degrees reach the hand no faster than the slew limit",
          "[virtual]") {
    const VirtualClock clock;
    const Outcome spike = run_patch(patch_text("spike", 500), 1.0, plain_hand);
    check_bounds(spike);
    CHECK(glm::length(spike.given[502].wrench.force) < 6.0);
    CHECK(force_at(spike, 520) == Approx(4.0));

    const Outcome jump = run_patch(patch_text("none", 0), 1.0, [](std::int64_t count) {
        DeviceSample sample = pressing(count);
        if (count >= 500) sample.pose.position.x = 15e-3;
        return sample;
    });
    check_bounds(jump);
    CHECK(force_at(jump, 900) == Approx(max_force));

    const Outcome flip = run_patch(patch_text("none", 0), 1.0, [](std::int64_t count) {
        DeviceSample sample = pressing(count);
        if (count >= 500) sample.pose.orientation = {0.0, 0.0, 1.0, 0.0};
        return sample;
    });
    check_bounds(flip);
    CHECK(glm::length(flip.given[900].wrench.torque) == Approx(max_torque));
}

TEST_CASE("no node gets round the limits that the device states") {
    DeviceInfo device;
    device.max_force = 10.0;
    device.max_torque = 1.0;
    CHECK(glm::length(io::clamp_to_device({{30.0, 40.0, 0.0}, {}}, device).force) == Approx(10.0));
    CHECK(glm::length(io::clamp_to_device({{}, {0.0, 3.0, 4.0}}, device).torque) == Approx(1.0));
    CHECK(io::clamp_to_device({{1.0, 2.0, 3.0}, {}}, device).force == Vec3(1.0, 2.0, 3.0));
    CHECK(io::clamp_to_device({{std::nan(""), 2.0, 3.0}, {0.1, 0.0, 0.0}}, device).torque == Vec3(0.0));
    CHECK(io::clamp_to_device({{30.0, 40.0, 0.0}, {}}, {}).force == Vec3(30.0, 40.0, 0.0));
}

TEST_CASE("a stalled tick loses the hand to the watchdog, which fades it, and the other groups and the log go on",
          "[virtual][slow]") {
    const VirtualClock clock;
    const auto log = std::filesystem::temp_directory_path() / ("tactus_stall_" + std::to_string(::getpid()));
    // Whether the watchdog took the hand while it felt a force.
    const auto check_watchdog = [](const Outcome& o) {
        const std::thread::id tick = o.given.front().by;
        bool taken = false;
        for (std::size_t i = 1; i < o.given.size(); ++i) {
            if (o.given[i].by != tick) {
                REQUIRE(force_at(o, i) <= force_at(o, i - 1) * (1.0 + 1e-12));
                taken = taken || force_at(o, i - 1) > 0.0;
            } else if (o.given[i - 1].by != tick) {
                // It comes back from zero only.
                REQUIRE(force_at(o, i - 1) == 0.0);
                REQUIRE(force_at(o, i) == 0.0);
            }
        }
        // At the end of the run nothing is left on the hand.
        CHECK(force_at(o, o.given.size() - 1) == 0.0);
        CHECK(o.other_ran + o.other_skipped == 160);
        CHECK(o.other_ran > 0);
        return taken && std::ranges::any_of(
                            o.faults, [](const io::DeviceFault& f) { return f.reason == control::Fault::late_commit; });
    };
    const auto stalled = [&](const char* stall) {
        return run_patch(patch_text("stall", 300, stall), 0.8, plain_hand, log);
    };
    check_watchdog(stalled("3 ms"));
    for (const char* stall : {"20 ms", "200 ms"}) {
        INFO("stalled for " << stall);
        CHECK(check_watchdog(stalled(stall)));
    }
    INFO("a driver that hangs while it is read");
    CHECK(check_watchdog(run_patch(
        patch_text("none", 0), 0.8,
        [](std::int64_t count) {
            if (count == 300) std::this_thread::sleep_for(std::chrono::milliseconds(100));
            return pressing(count);
        },
        log)));
}

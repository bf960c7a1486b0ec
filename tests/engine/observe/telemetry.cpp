// SPDX-License-Identifier: Apache-2.0
#include "engine/observe/telemetry.hpp"

#include "tests/engine/chaos.hpp"
#include "tests/engine/played_device.hpp"
#include "tests/engine/watched_hand.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("a late call is blamed on the largest of late start, standstill and computing") {
    CHECK(observe::blame(50, observe::LateCause::woken_late, 30, 20) == observe::LateCause::woken_late);
    CHECK(observe::blame(50, observe::LateCause::ran_long, 30, 20) == observe::LateCause::ran_long);
    CHECK(observe::blame(5, observe::LateCause::woken_late, 100, 20) == observe::LateCause::preempted);
    CHECK(observe::blame(5, observe::LateCause::woken_late, 100, 90) == observe::LateCause::ran_long);
}

TEST_CASE("a force of one tick is not missed by who looks ten times a second") {
    observe::GroupTelemetry t;
    for (const double force : {1.0, 9.0, 2.0}) t.note_force(force);
    CHECK(t.force_N.load() == 2.0);
    CHECK(t.take_most_force() == 9.0);
    t.note_force(3.0);
    CHECK(t.take_most_force() == 3.0);
    CHECK(t.take_most_force() == 0.0);
}

TEST_CASE("of two hands of a group the larger force is told, whichever comes last") {
    for (const bool left_is_firm : {true, false}) {
        for (const char* name : {"left", "right"}) watched_hand(name);
        PatchText patch;
        add_hand(patch, "left", left_is_firm ? "2 N/mm" : "1 N/mm");
        add_hand(patch, "right", left_is_firm ? "1 N/mm" : "2 N/mm");
        run::EngineOptions options;
        options.seconds = 0.4;
        run::Engine engine(compile_text(patch.toml()), options);
        engine.render(1);
        CHECK(engine.groups()[0]->telemetry.force_N.load() == Approx(4.0));
        CHECK(engine.groups()[0]->telemetry.take_most_force() == Approx(4.0));
    }
}

namespace {

/// Skips of the 1 kHz group by cause, when its tick 300 lasts 15 ms: `busy` computing, else waiting in the driver. A
/// longer one would lose its real-time priority.
std::array<std::int64_t, observe::late_causes> skips_after(bool busy) {
    Performance performance;
    performance.acquire = [busy](std::int64_t count, double, const Wrench&) {
        if (!busy && count == 300) std::this_thread::sleep_for(std::chrono::milliseconds(15));
        DeviceSample sample;
        sample.counter = count;
        sample.valid = true;
        return sample;
    };
    play_as("slow", performance);
    const std::string patch =
        PatchText{
            {{"hand", "device_input", "1 kHz", {{"device", "slow"}}},
             {"plant", "planted", "1 kHz", {{"fault", busy ? "stall" : "none"}, {"at", "300"}, {"stall", "15 ms"}}}},
            {"hand.pose -> plant.pose"},
            "[devices.slow]\ndriver = \"slow\"\n"}
            .toml();
    run::EngineOptions options;
    options.seconds = 0.5;
    options.live = true;
    run::Engine engine(compile_text(patch), options);
    engine.run_live({});
    const observe::GroupTelemetry& t = engine.groups()[0]->telemetry;
    std::array<std::int64_t, observe::late_causes> skips{};
    std::int64_t all = 0;
    for (std::size_t c = 0; c < observe::late_causes; ++c)
        all += skips[c] = t.skip_causes[static_cast<observe::LateCause>(c)];
    CHECK(all == t.skipped.load());
    return skips;
}

}  // namespace

TEST_CASE("every skipped tick has its cause: a node that computes too long, or a thread that stands still",
          "[virtual]") {
    const VirtualClock clock;
    CHECK(skips_after(true)[static_cast<std::size_t>(observe::LateCause::ran_long)] >= 12);
    CHECK(skips_after(false)[static_cast<std::size_t>(observe::LateCause::preempted)] >= 12);
}

TEST_CASE("nodes are timed in one call of 64, and told by name") {
    run::EngineOptions options;
    options.seconds = 6.4;
    run::Engine engine(
        compile_text(
            PatchText{{{"a", "chaos", "1 kHz", {}}, {"b", "chaos", "1 kHz", {{"work", "2000"}}}}, {"a.out -> b.in"}, ""}
                .toml()),
        options);
    engine.render(1);
    REQUIRE(engine.nodes().size() == 2);
    const build::LiveNode &a = *engine.nodes()[0], &b = *engine.nodes()[1];
    CHECK(a.name == "a");
    CHECK(a.time.calls == 100);
    CHECK(b.time.calls == 100);
    CHECK(b.time.mean_ns() > a.time.mean_ns());
}

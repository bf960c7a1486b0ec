// SPDX-License-Identifier: Apache-2.0
// A live run that pauses: forces fade, logical time stands still, and a take knows nothing of how long.
#include "engine/take/take_stream.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

using namespace tactus;
using namespace tactus::test;

namespace {

/// The hand rests at the middle of a soft spring, beside sound and a slow node that are wired to it. The other end of
/// the spring moves by itself: the energy cap would take part of the force away at any time.
const std::string held = R"(wires = [
  "hand.pose -> spring.device",
  "place.pose -> spring.object",
  "spring.wrench -> out.wrench",
  "voice.level -> place.gain",
  "place.out -> voice.glide as linear",
]
[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "simulated"
[nodes.place]
type = "chaos"
rate = "60 Hz"
[nodes.spring]
type = "spring"
rate = "1 kHz"
stiffness = "0.001 N/mm"
[nodes.out]
type = "device_output"
rate = "1 kHz"
device = "simulated"
energy_cap = false
[nodes.voice]
type = "chaos_signal"
rate = "48 kHz"
)";

using Seconds = std::chrono::duration<double>;

}  // namespace

TEST_CASE("a pause fades the force, stops logical time for all groups, and replays to the bit", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("pause");
    run::Engine::PortHashes live_hashes;
    double stood_at = 0.0, stood_for = 0.0, moved = 0.0;
    std::size_t faults = 0;
    {
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 0.8, .live = true});
        run::EngineOptions options;
        options.seconds = 0.8;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(held), options);
        run::LiveOptions live;
        std::chrono::steady_clock::time_point began;
        int stage = 0;
        live.watch = [&] {
            if (stage == 0 && engine.progress_seconds() > 0.3) {
                engine.pause(true);
                stage = 1;
            } else if (stage == 1 && engine.pausing() == run::Engine::Pausing::stands) {
                began = std::chrono::steady_clock::now();
                stood_at = engine.progress_seconds();
                stage = 2;
            } else if (stage == 2 && Seconds(std::chrono::steady_clock::now() - began).count() > 0.3) {
                stood_for = Seconds(std::chrono::steady_clock::now() - began).count();
                moved = engine.progress_seconds() - stood_at;
                engine.pause(false);
                stage = 3;
            }
        };
        engine.run_live(live);
        engine.finish();
        CHECK(stage == 3);
        CHECK(engine.pausing() == run::Engine::Pausing::runs);
        live_hashes = engine.port_hashes();
        for (const auto& slot : engine.host().devices) faults += slot->guard.faults().size();
        // Nobody is late for having waited.
        for (const auto& group : engine.groups()) CHECK(group->telemetry.skipped == 0);
    }
    CHECK(stood_for > 0.3);
    CHECK(moved == 0.0);
    CHECK(faults == 0);

    const Repetition again = repeat(folder, 2);
    if (again.difference) FAIL(again.difference->port << " differs at tick " << again.difference->tick);
    CHECK(again.hashes == live_hashes);
    CHECK(again.matches_result);

    const take::Take take = take::Take::load(folder);
    const auto forces = [&](const std::string& port) {
        std::vector<double> force;
        for (const take::TakeStreamInfo& info : take.streams) {
            if (info.port != port) continue;
            take::TakeStreamReader reader(folder / info.file, info);
            for (std::int64_t tick = 0; const double* frame = reader.frame(tick); ++tick)
                force.push_back(std::hypot(frame[0], frame[1], frame[2]));
        }
        return force;
    };
    const std::vector<double> wanted = forces("spring.wrench"), applied = forces("out.applied");
    const auto last = static_cast<std::size_t>(std::lround(stood_at * 1e3)) - 1;
    REQUIRE(applied.size() > last + 200);
    REQUIRE(wanted.size() == applied.size());
    const auto most = [](const std::vector<double>& of, std::size_t from, std::size_t to) {
        return *std::max_element(of.begin() + static_cast<std::ptrdiff_t>(from),
                                 of.begin() + static_cast<std::ptrdiff_t>(to));
    };
    const double largest = most(applied, last - 90, last - 30);
    CHECK(largest > 0.05);
    CHECK(applied[last] == 0.0);
    CHECK(applied[last + 1] == 0.0);
    CHECK(most(applied, applied.size() - 150, applied.size()) > 0.05);
    // It fades and comes in by steps of at most a tenth beyond those of the spring, never at once.
    for (std::size_t i = last - 60; i < last + 200; ++i) {
        const double step = std::abs(applied[i + 1] - applied[i]);
        REQUIRE(step <= std::abs(wanted[i + 1] - wanted[i]) + 0.101 * most(wanted, last - 90, last + 200));
    }
    std::filesystem::remove_all(folder);
}

TEST_CASE("a run that is to end while it pauses goes on to its end", "[virtual]") {
    const VirtualClock clock;
    run::EngineOptions options;
    options.seconds = 5.0;
    options.live = true;
    run::Engine engine(compile_text(held), options);
    std::atomic<bool> stop{false};
    run::LiveOptions live;
    live.stop = &stop;
    live.watch = [&] {
        if (engine.progress_seconds() > 0.05) engine.pause(true);
        if (engine.pausing() == run::Engine::Pausing::stands) stop = true;
    };
    engine.run_live(live);
    CHECK(stop);
    CHECK(engine.progress_seconds() < 4.0);
}

TEST_CASE("a node of a new rate that an edit brings while a run pauses waits with the others, and the take repeats it",
          "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("pause-edit");
    const std::string more = held + "[nodes.fresh]\ntype = \"chaos\"\nrate = \"200 Hz\"\n";
    take::TakeWriter take(folder, {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 0.6, .live = true});
    run::EngineOptions options;
    options.seconds = 0.6;
    options.live = true;
    options.take = &take;
    run::Engine engine(compile_text(held), options);
    run::LiveOptions live;
    int stage = 0;
    std::int64_t ran_while_paused = 0;
    std::chrono::steady_clock::time_point asked;
    const auto fresh = [&]() -> const run::GroupRuntime& { return *engine.groups().back(); };
    live.watch = [&] {
        if (stage == 0 && engine.progress_seconds() > 0.2) {
            engine.pause(true);
            stage = 1;
        } else if (stage == 1 && engine.pausing() == run::Engine::Pausing::stands) {
            engine.edit([&] { return compile_text(more); }, {});
            stage = 2;
        } else if (stage == 2 && engine.edits() == 1) {
            asked = std::chrono::steady_clock::now();
            stage = 3;
        } else if (stage == 3 && Seconds(std::chrono::steady_clock::now() - asked).count() > 0.1) {
            ran_while_paused = fresh().telemetry.ticks;
            engine.pause(false);
            stage = 4;
        }
    };
    engine.run_live(live);
    engine.finish();
    REQUIRE(stage == 4);
    REQUIRE(engine.groups().size() == 4);
    CHECK(fresh().plan->period == flicks_per_second / 200);
    CHECK(ran_while_paused == 0);
    CHECK(fresh().telemetry.ticks > 0);
    const Repetition again = repeat(folder, 2);
    if (again.difference) FAIL(again.difference->port << " differs at tick " << again.difference->tick);
    CHECK(again.hashes == engine.port_hashes());
    std::filesystem::remove_all(folder);
}

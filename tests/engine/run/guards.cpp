// SPDX-License-Identifier: Apache-2.0
// That forces go when they must, and stay as they are otherwise, whatever else is in the patch.
#include "tests/engine/chaos.hpp"
#include "tests/engine/live_case.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("a stop takes the force away at once and ends the run soon, however slow another group is", "[virtual]") {
    const VirtualClock clock;
    for (const char* rate : {"0.2 Hz", "4 Hz", "60 Hz"}) {
        INFO(rate);
        const WatchedHand& hand = watched_hand("left");
        const LiveOutcome o =
            run_case({with_slow_group(rate), 30.0, [](run::Engine&) {}, [](run::Engine&) { return true; }}, hand);
        CHECK(hand.largest_after(0) == Approx(2.0));
        CHECK(hand.ms_to_zero(o.stopped_ns) < prompt_ms);
        CHECK(ms_between(o.stopped_ns, o.returned_ns) < 1500.0);
        CHECK(o.faults.empty());
    }
}

TEST_CASE("a pause takes the force away at once, however slow another group is, and the take repeats it", "[virtual]") {
    const VirtualClock clock;
    for (const char* rate : {"0.2 Hz", "4 Hz"}) {
        INFO(rate);
        const auto folder = scratch("slow-pause");
        WatchedHand& hand = watched_hand("left");
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 30.0, .live = true});
        std::optional<std::int64_t> stands, resumed;
        const auto go_on = [&](run::Engine& engine) {
            if (!stands && engine.pausing() == run::Engine::Pausing::stands) {
                stands = steady_now();
                CHECK(hand.force() == 0.0);
            }
            if (!resumed && stands && ms_between(*stands, steady_now()) > 100.0) {
                resumed = steady_now();
                hand.depth = 0.2e-3;  // else the force would be too large to come in anew
                engine.pause(false);
            }
            return resumed && ms_between(*resumed, steady_now()) > 400.0;
        };
        const LiveOutcome o = run_case(
            {with_slow_group(rate), 30.0, [](run::Engine& engine) { engine.pause(true); }, go_on, &take}, hand);
        const Repetition again = repeat(folder, 2);
        CHECK_FALSE(again.difference);
        CHECK(again.hashes == o.hashes);
        std::filesystem::remove_all(folder);
        REQUIRE(resumed);
        CHECK(ms_between(o.done_ns, *stands) < 1500.0);
        double last_force = 0.0;
        for (const auto& given : hand.given())
            if (given.ns > o.done_ns && given.ns < *resumed && given.force_N > 0.0)
                last_force = ms_between(o.done_ns, given.ns);
        CHECK(last_force < prompt_ms);
        CHECK(hand.largest_after(*resumed) == Approx(0.2));
        CHECK(o.faults.empty());
    }
}

TEST_CASE("a parameter that is set holds within 5 ms, whatever else is in the patch", "[virtual]") {
    const VirtualClock clock;
    for (const std::string& text :
         {with_slow_group("0.2 Hz"), with_slow_group("4 Hz"), "quantum = \"500 ms\"\n" + with_slow_group("60 Hz")}) {
        WatchedHand& hand = watched_hand("left");
        double asked_at = 0.0, holds_at = 0.0;
        run_case({text, 30.0,
                  [&](run::Engine& engine) {
                      asked_at = hand.logical_s;
                      holds_at = seconds(engine.set("near", "gain", "0.5"));
                  },
                  [](run::Engine&) { return true; }},
                 hand);
        CHECK(holds_at > asked_at);
        CHECK(holds_at - asked_at < 5.5e-3);
    }
}

TEST_CASE("an edit takes over soon, however slow another group is", "[virtual]") {
    const VirtualClock clock;
    WatchedHand& hand = watched_hand("left");
    double asked_at = 0.0, when = 0.0;
    PatchText other;
    add_hand(other, "left", "1 N/mm", "other");
    other.nodes.push_back({"slow", "chaos", "0.2 Hz", {}});
    other.nodes.push_back({"near", "chaos", "1 kHz", {}});
    other.wires.insert(other.wires.end(), {"near.out -> slow.in", "slow.out -> near.in"});
    run_case({with_slow_group("0.2 Hz"), 30.0,
              [&](run::Engine& engine) {
                  asked_at = hand.logical_s;
                  engine.edit([&] { return compile_text(other.toml()); },
                              [&](const run::EditOutcome& outcome) { when = seconds(outcome.when); });
              },
              [&](run::Engine&) { return when > 0.0; }},
             hand);
    CHECK(when > asked_at);
    CHECK(when - asked_at < 0.5);
}

TEST_CASE("an error right after an edit that adds a group ends the run with that error", "[virtual]") {
    const VirtualClock clock;
    WatchedHand& hand = watched_hand("left");
    PatchText more;
    add_hand(more, "left");
    more.nodes.push_back({"fresh", "chaos", "200 Hz", {}});
    bool told = false;
    int calls = 0;
    CHECK_THROWS_WITH(run_case({with_slow_group("60 Hz"), 30.0,
                                [&](run::Engine& engine) {
                                    engine.edit([&] { return compile_text(more.toml()); },
                                                [&](const run::EditOutcome&) { told = true; });
                                },
                                // The call after the edit comes while the new group waits for its first tick.
                                [&](run::Engine&) -> bool {
                                    if (told && ++calls == 2) throw Error("planted");
                                    return false;
                                }},
                               hand),
                      "planted");
    CHECK(hand.force() == 0.0);
}

TEST_CASE("a parameter that is set just before its node goes is set on nothing else", "[virtual]") {
    const VirtualClock clock;
    const std::string quantum = "quantum = \"500 ms\"\n";
    const auto text = [&](const std::string& name) {
        PatchText patch;
        add_hand(patch, "left");
        for (int i = 0; i < 20; ++i)
            patch.nodes.push_back({name + std::to_string(i), "chaos", "1 kHz", {{"gain", "0.25"}}});
        return quantum + patch.toml();
    };
    WatchedHand& hand = watched_hand("left");
    std::int64_t edits = 0;
    bool is_waiting = false;
    double latest = 0.0;
    run_case({text("a"), 30.0, [](run::Engine&) {},
              [&](run::Engine& engine) {
                  if (is_waiting || !engine.is_settled()) return false;
                  if (edits == 6) return true;
                  const std::string now = edits % 2 == 0 ? "a" : "b", next = edits % 2 == 0 ? "b" : "a";
                  for (int i = 0; i < 20; ++i)
                      latest = std::max(latest,
                                        seconds(engine.set(now + std::to_string(i), "gain", "0.5")) - hand.logical_s);
                  is_waiting = true;
                  engine.edit([&, next] { return compile_text(text(next)); },
                              [&](const run::EditOutcome& outcome) {
                                  CHECK_FALSE(outcome.error);
                                  ++edits;
                                  is_waiting = false;
                              });
                  return false;
              }},
             hand);
    CHECK(edits == 6);
    // What would be set later than the edit takes over would be set in memory that is given back.
    CHECK(latest < 0.045);
}

TEST_CASE("ticks that are late by most of a period are not run back to back against a hand", "[virtual]") {
    const VirtualClock clock;
    // Each tick of 50 Hz in a row lasts 1.9 periods.
    WatchedHand& hand = watched_hand("left");
    PatchText patch;
    add_hand(patch, "left", "1 N/mm", "spring", "50 Hz");
    for (int i = 0; i < 5; ++i)
        patch.nodes.push_back({"plant" + std::to_string(i),
                               "planted",
                               "50 Hz",
                               {{"fault", "stall"}, {"at", std::to_string(30 + 4 * i)}, {"stall", "38 ms"}}});
    for (int i = 0; i < 5; ++i) patch.wires.emplace_back("left_hand.pose -> plant" + std::to_string(i) + ".pose");
    std::mutex lock;
    std::vector<std::int64_t> began;
    const auto acquire = hand.performance.acquire;
    hand.performance.acquire = [&](std::int64_t count, double elapsed, const Wrench& force) {
        const std::lock_guard guard(lock);
        began.push_back(steady_now());
        return acquire(count, elapsed, force);
    };
    run_case({patch.toml(), 30.0, [](run::Engine&) {}, [](run::Engine&) { return true; }, nullptr, 1.2}, hand);
    double least = 1e9;
    for (std::size_t i = 2; i < began.size(); ++i) least = std::min(least, ms_between(began[i - 1], began[i]));
    CHECK(began.size() > 40);
    CHECK(least > 9.0);
}

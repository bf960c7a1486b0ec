// SPDX-License-Identifier: Apache-2.0
// A driver that blocks keeps neither another hand nor the run.
#include "tests/engine/chaos.hpp"
#include "tests/engine/live_case.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <thread>

using namespace tactus;
using namespace tactus::test;

TEST_CASE(
    "a driver that blocks when the guard speaks to it disarms the guard of no other device, nor the end of the run",
    "[virtual]") {
    const VirtualClock clock;
    WatchedHand &left = watched_hand("left"), &right = watched_hand("right");
    PatchText patch;
    add_hand(patch, "left");
    add_hand(patch, "right");
    patch.nodes.push_back({"plant", "planted", "1 kHz", {{"fault", "stall"}, {"at", "400"}, {"stall", "300 ms"}}});
    patch.wires.emplace_back("left_hand.pose -> plant.pose");
    left.blocks = WatchedHand::Blocks::in_commit_of_the_guard;
    const LiveOutcome o = run_case({patch.toml(), 30.0, [](run::Engine&) {}, [](run::Engine&) { return true; }}, right);
    CHECK(left.is_blocked);
    // The last force before the stall, and the first of none.
    const auto given = right.given();
    const auto by_guard = std::ranges::find_if(given, [&](const auto& g) { return g.by != given.front().by; });
    REQUIRE(by_guard != given.end());
    REQUIRE(by_guard != given.begin());
    const std::int64_t last_tick = std::prev(by_guard)->ns;
    CHECK(std::prev(by_guard)->force_N == Approx(2.0));
    const auto zero = std::find_if(by_guard, given.end(), [](const auto& g) { return g.force_N == 0.0; });
    REQUIRE(zero != given.end());
    CHECK(ms_between(last_tick, zero->ns) < prompt_ms);
    CHECK(ms_between(o.stopped_ns, o.returned_ns) < 2000.0);
    left.blocks = WatchedHand::Blocks::never;
}

TEST_CASE("a driver that never comes back keeps neither the other hand's force nor the run", "[virtual]") {
    const VirtualClock clock;
    for (const auto blocks : {WatchedHand::Blocks::in_acquire, WatchedHand::Blocks::in_commit}) {
        WatchedHand &left = watched_hand("left"), &right = watched_hand("right");
        PatchText patch;
        add_hand(patch, "left");
        add_hand(patch, "right");
        patch.nodes.push_back({"other", "chaos", "200 Hz", {}});
        patch.nodes.push_back({"near", "chaos", "1 kHz", {}});
        patch.wires.insert(patch.wires.end(), {"near.out -> other.in", "other.out -> near.in"});
        const auto folder = scratch("never-back");
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 30.0, .live = true});
        const LiveOutcome o = run_case({patch.toml(), 30.0, [&](run::Engine&) { left.blocks = blocks; },
                                        [&](run::Engine&) { return left.is_blocked && right.force() == 0.0; }, &take},
                                       right);
        CHECK(right.ms_to_zero(o.done_ns) < prompt_ms + 5.0);
        CHECK(ms_between(o.stopped_ns, o.returned_ns) < 2000.0);
        // It comes back after the run is gone.
        left.blocks = WatchedHand::Blocks::never;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        CHECK_FALSE(left.is_blocked);
        const Repetition again = repeat(folder, 2);
        CHECK_FALSE(again.difference);
        CHECK(again.hashes == o.hashes);
        std::filesystem::remove_all(folder);
    }
}

TEST_CASE("a driver that comes back late from a commit is faded, not cut, and comes in anew", "[virtual]") {
    const VirtualClock clock;
    PatchText patch;
    add_hand(patch, "left");
    WatchedHand& hand = watched_hand("left");
    double before = 0.0;
    std::int64_t blocked = 0;
    const auto block = [&](run::Engine&) {
        before = hand.force();
        hand.blocks = WatchedHand::Blocks::in_commit;
    };
    const auto unblock = [&](run::Engine&) {
        if (blocked == 0 && hand.is_blocked) {
            blocked = steady_now();
            hand.blocks = WatchedHand::Blocks::never;
        }
        return blocked != 0 && ms_between(blocked, steady_now()) > 200.0;
    };
    const LiveOutcome o = run_case({patch.toml(), 30.0, block, unblock}, hand);
    CHECK(before == 2.0);
    const auto given = hand.given();
    double largest = 0.0, last = 0.0;
    for (std::size_t i = 1; i < given.size(); ++i) {
        if (given[i].ns < o.done_ns || given[i].ns > o.stopped_ns) continue;
        // Nobody fades in less than 10 ms.
        largest = std::max(largest, (given[i - 1].force_N - given[i].force_N) /
                                        std::max(ms_between(given[i - 1].ns, given[i].ns), 1.0));
        last = given[i].force_N;
    }
    CHECK(largest > 0.1);
    CHECK(largest < 0.3);
    CHECK(last == 0.0);
    REQUIRE(o.faults.size() == 1);
    CHECK(o.faults[0] == describe(control::Fault::late_commit));
}

TEST_CASE("a driver that never opens keeps neither the end of the run nor the hands that are there", "[virtual]") {
    const VirtualClock clock;
    WatchedHand &left = watched_hand("left"), &right = watched_hand("right");
    PatchText plain, more;
    add_hand(plain, "left");
    add_hand(more, "left");
    add_hand(more, "right");
    right.blocks = WatchedHand::Blocks::in_acquire;
    bool told = false;
    const LiveOutcome o = run_case({plain.toml(), 30.0,
                                    [&](run::Engine& engine) {
                                        engine.edit([&] { return compile_text(more.toml()); },
                                                    [&](const run::EditOutcome&) { told = true; });
                                    },
                                    [&](run::Engine&) { return right.is_blocked.load(); }},
                                   left);
    CHECK_FALSE(told);
    CHECK(left.ms_to_zero(o.stopped_ns) < prompt_ms);
    CHECK(ms_between(o.stopped_ns, o.returned_ns) < 2000.0);
    right.blocks = WatchedHand::Blocks::never;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    CHECK_FALSE(right.is_blocked);
}

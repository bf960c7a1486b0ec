// SPDX-License-Identifier: Apache-2.0
// That forces go when they must, whatever else is in the patch and whoever is blocked.
#include "tests/engine/chaos.hpp"
#include "tests/engine/refused_threads.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/engine/watched_hand.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <system_error>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double prompt_ms = 20.0;

std::string with_slow_group(const std::string& rate) {
    PatchText patch;
    add_hand(patch, "left");
    patch.nodes.push_back({"slow", "chaos", rate, {}});
    patch.nodes.push_back({"near", "chaos", "1 kHz", {}});
    patch.wires.insert(patch.wires.end(), {"near.out -> slow.in", "slow.out -> near.in"});
    return patch.toml();
}

/// A live run with one thing done after `at` seconds of the hand's time; 'watch' goes on being called.
struct LiveCase {
    std::string text;
    double seconds = 30.0;
    std::function<void(run::Engine&)> deed;  ///< once
    std::function<bool(run::Engine&)> is_over;  ///< asked after the deed: the run is to stop
    take::TakeWriter* take = nullptr;
    double at = 0.5;
};

struct LiveOutcome {
    std::int64_t done_ns = 0, returned_ns = 0, stopped_ns = 0;
    run::Engine::PortHashes hashes;
    std::vector<std::string> faults;
};

LiveOutcome run_case(const LiveCase& what, const WatchedHand& hand) {
    run::EngineOptions options;
    options.seconds = what.seconds;
    options.live = true;
    options.take = what.take;
    run::Engine engine(compile_text(what.text), options);
    std::atomic<bool> stop{false};
    LiveOutcome outcome;
    run::LiveOptions live;
    live.stop = &stop;
    live.watch = [&] {
        if (outcome.done_ns == 0 && hand.logical_s > what.at) {
            outcome.done_ns = steady_now();
            what.deed(engine);
        }
        if (outcome.done_ns != 0 && !stop && what.is_over(engine)) {
            outcome.stopped_ns = steady_now();
            stop = true;
        }
    };
    engine.run_live(live);
    outcome.returned_ns = steady_now();
    engine.finish();
    outcome.hashes = engine.port_hashes();
    for (const auto& slot : engine.host().devices)
        for (const io::DeviceFault& fault : slot->guard.faults()) outcome.faults.emplace_back(describe(fault.reason));
    return outcome;
}

/// The machine is busy with other things now and then, and ticks come too late: then a hand is let go of before it is
/// time. Such a run is repeated.
constexpr int attempts = 5;

double ms_between(std::int64_t from, std::int64_t to) { return static_cast<double>(to - from) * 1e-6; }

}  // namespace

TEST_CASE("a stop takes the force away at once and ends the run soon, however slow another group is", "[live]") {
    for (const char* rate : {"0.2 Hz", "4 Hz", "60 Hz"}) {
        INFO(rate);
        LiveOutcome o;
        WatchedHand* played = nullptr;
        for (int i = 0; i == 0 || (i < attempts && !o.faults.empty()); ++i) {
            played = &watched_hand("left");
            o = run_case({with_slow_group(rate), 30.0, [](run::Engine&) {}, [](run::Engine&) { return true; }},
                         *played);
        }
        const WatchedHand& hand = *played;
        CHECK(hand.largest_after(0) == Approx(2.0));
        CHECK(hand.ms_to_zero(o.stopped_ns) < prompt_ms);
        CHECK(ms_between(o.stopped_ns, o.returned_ns) < 1500.0);
        CHECK(o.faults.empty());
    }
}

TEST_CASE("a pause takes the force away at once, however slow another group is, and the take repeats it", "[live]") {
    for (const char* rate : {"0.2 Hz", "4 Hz"}) {
        INFO(rate);
        for (int attempt = 1;; ++attempt) {
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
            if (!o.faults.empty() && attempt < attempts) continue;
            REQUIRE(resumed);
            CHECK(ms_between(o.done_ns, *stands) < 1500.0);
            double last_force = 0.0;
            for (const auto& given : hand.given())
                if (given.ns > o.done_ns && given.ns < *resumed && given.force_N > 0.0)
                    last_force = ms_between(o.done_ns, given.ns);
            CHECK(last_force < prompt_ms);
            CHECK(hand.largest_after(*resumed) == Approx(0.2));
            CHECK(o.faults.empty());
            break;
        }
    }
}

TEST_CASE("a parameter that is set holds within 5 ms, whatever else is in the patch", "[live]") {
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

TEST_CASE("an edit takes over soon, however slow another group is", "[live]") {
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

TEST_CASE(
    "a driver that blocks when the guard speaks to it disarms the guard of no other device, nor the end of the run",
    "[live]") {
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

TEST_CASE("a driver that never comes back keeps neither the other hand's force nor the run", "[live]") {
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

TEST_CASE("a driver that comes back late from a commit is faded, not cut, and comes in anew", "[live]") {
    PatchText patch;
    add_hand(patch, "left");
    for (int attempt = 1;; ++attempt) {
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
        if ((before != 2.0 || o.faults.size() > 1) && attempt < attempts) continue;
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
        break;
    }
}

TEST_CASE("a driver that never opens keeps neither the end of the run nor the hands that are there", "[live]") {
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

TEST_CASE("a run whose threads are refused says so and does not hang", "[live]") {
    watched_hand("left");
    PatchText patch;
    add_hand(patch, "left");
    for (const char* rate : {"500 Hz", "200 Hz", "60 Hz"})
        patch.nodes.push_back({std::string("n") + rate[0], "chaos", rate, {}});
    for (int allowed = 0; allowed < 6; ++allowed) {
        INFO(allowed << " threads");
        run::EngineOptions options;
        options.seconds = 0.05;
        options.live = true;
        run::Engine engine(compile_text(patch.toml()), options);
        const RefusedThreads refused(allowed);
        bool failed = false;
        try {
            engine.run_live({});
        } catch (const std::system_error& error) {
            failed = true;
            CHECK_THAT(error.what(), Catch::Matchers::ContainsSubstring("thread"));
        }
        CHECK(failed == (refused.asked() > allowed));
    }
}

TEST_CASE("an edit whose threads are refused is not made, and the patch runs on as it was", "[live]") {
    WatchedHand& hand = watched_hand("left");
    watched_hand("right");
    PatchText plain, more;
    add_hand(plain, "left");
    add_hand(more, "left");
    add_hand(more, "right");
    for (const char* rate : {"500 Hz", "200 Hz", "60 Hz"})
        more.nodes.push_back({std::string("n") + rate[0], "chaos", rate, {}});
    int failed = 0, made = 0;
    std::optional<RefusedThreads> refused;
    int allowed = 0;
    bool is_waiting = false;
    run_case({plain.toml(), 30.0, [](run::Engine&) {},
              [&](run::Engine& engine) {
                  if (is_waiting || !engine.is_settled()) return false;
                  if (made > 0) return true;
                  is_waiting = true;
                  refused.reset();
                  refused.emplace(allowed++);
                  engine.edit([&] { return compile_text(more.toml()); },
                              [&](const run::EditOutcome& outcome) {
                                  is_waiting = false;
                                  (outcome.error ? failed : made) += 1;
                                  if (outcome.error)
                                      CHECK_THAT(*outcome.error, Catch::Matchers::ContainsSubstring("thread"));
                              });
                  return false;
              }},
             hand);
    CHECK(made == 1);
    CHECK(failed >= 3);
    CHECK(hand.largest_after(0) == Approx(2.0));
}

TEST_CASE("an error right after an edit that adds a group ends the run with that error", "[live]") {
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

TEST_CASE("a parameter that is set just before its node goes is set on nothing else", "[live]") {
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

TEST_CASE("ticks that are late by most of a period are not run back to back against a hand", "[live]") {
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

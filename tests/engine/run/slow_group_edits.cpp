// SPDX-License-Identifier: Apache-2.0
// Edits of a live run with a group that is seldom due: they do not wait for its next activation.
#include "engine/run/group_runtime.hpp"
#include "engine/run/replayed_decisions.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/engine/watched_hand.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <fmt/format.h>

#include <filesystem>

using namespace tactus;
using namespace tactus::test;

namespace {

/// A chaotic node at 1 kHz that hears another at 0.2 Hz, and a slow node that is there in every other edit.
std::string with_slow_group(int edit) {
    PatchText patch;
    patch.nodes = {{"fast", "chaos", "1 kHz", {{"gain", fmt::format("{}", 0.01 * (edit + 1))}}},
                   {"slow", "chaos", "0.2 Hz", {{"gain", fmt::format("{}", 0.02 * (edit + 1))}}}};
    if (edit % 2 == 1) patch.nodes.push_back({"guest", "chaos", "0.2 Hz", {}});
    patch.wires = {"slow.out -> fast.in"};
    return patch.toml();
}

}  // namespace

TEST_CASE("edits do not wait for a slow group, and the take repeats them", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("slow-group");
    constexpr int edits = 3;
    run::Engine::PortHashes live_hashes;
    std::vector<std::int64_t> asked_ns, settled_ns;
    {
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 60.0, .live = true});
        run::EngineOptions options;
        options.seconds = 60.0;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(with_slow_group(0)), options);
        std::atomic<bool> stop{false};
        run::LiveOptions live;
        live.stop = &stop;
        live.watch = [&] {
            if (!engine.is_settled() || engine.progress_seconds() < 0.0) return;
            if (asked_ns.empty() && engine.groups().front()->done() < 100) return;
            if (settled_ns.size() < asked_ns.size()) settled_ns.push_back(steady_now());
            if (asked_ns.size() == edits) {
                stop = true;
                return;
            }
            asked_ns.push_back(steady_now());
            engine.edit([number = static_cast<int>(asked_ns.size())] { return compile_text(with_slow_group(number)); },
                        [](const run::EditOutcome& outcome) { CHECK_FALSE(outcome.error); });
        };
        engine.run_live(live);
        engine.finish();
        live_hashes = engine.port_hashes();
    }
    REQUIRE(settled_ns.size() == edits);
    // The slow group is due at 0 s and at 5 s.
    CHECK(settled_ns.back() - asked_ns.front() < 3'000'000'000);
    const Repetition again = repeat(folder, 2);
    CHECK_FALSE(again.difference);
    CHECK(again.hashes == live_hashes);
    CHECK(again.matches_result);
    std::filesystem::remove_all(folder);
}

TEST_CASE("a log in which plans took over before an activation was left out is followed in that order") {
    const auto record = [](take::TimingKind kind, std::int64_t tick, std::int64_t value, int count) {
        take::TimingRecord one;
        one.kind = kind;
        one.tick = tick;
        one.value = value;
        one.count = count;
        return one;
    };
    const std::vector<take::TimingRecord> records{record(take::TimingKind::plan, 4, 1, 0),
                                                  record(take::TimingKind::plan, 4, 2, 0),
                                                  record(take::TimingKind::skipped, 4, 0, 3)};
    run::DecisionLog log(0);
    const run::ReplayedChanges none;
    run::ReplayedDecisions decisions(log, take::GroupRecords(records), none);
    build::GroupProgram first, second;
    first.plan_number = 1;
    second.plan_number = 2;
    CHECK(decisions.skip_from(4) == 4);
    CHECK_FALSE(decisions.switches_to(second, 3));
    CHECK(decisions.switches_to(first, 4));
    CHECK(decisions.skip_from(4) == 4);
    CHECK(decisions.switches_to(second, 4));
    CHECK(decisions.skip_from(4) == 7);
}

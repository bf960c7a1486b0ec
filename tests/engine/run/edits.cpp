// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"
#include "tests/support/virtual_clock.hpp"

#include <fmt/format.h>

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <map>

using namespace tactus;
using namespace tactus::test;

namespace {

struct Edit {
    Flicks when;
    std::string text;
};

std::map<std::string, std::uint64_t> hashes_of(const std::string& first, const std::vector<Edit>& edits, int threads,
                                               int block, bool random_blocks, double length) {
    run::EngineOptions options;
    options.seconds = length;
    options.block = block;
    options.random_blocks = random_blocks;
    run::Engine engine(compile_text(first), options);
    for (const Edit& edit : edits) engine.schedule(compile_text(edit.text), edit.when);
    engine.render(threads);
    const auto ports = engine.port_hashes();
    return {ports.begin(), ports.end()};
}

std::map<std::string, std::uint64_t> hashes_of(const std::string& first, const std::vector<Edit>& edits,
                                               double length = 0.5) {
    return hashes_of(first, edits, 1, 0, false, length);
}

std::string with(std::string text, const std::string& what, const std::string& instead) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), instead);
}

}  // namespace

TEST_CASE("an edit that changes nothing changes no bit") {
    const std::string patch = four_rates();
    const auto reference = hashes_of(patch, {});
    CHECK(hashes_of(patch, {{100 * ms, "# a comment\n" + patch}}) == reference);
    CHECK(hashes_of(patch, {{33 * ms, patch}, {34 * ms, patch}, {201 * ms, patch}}) == reference);
}

TEST_CASE("what an edit does not reach goes on with the same bits, delays and channels included") {
    const std::string patch = four_rates();
    const auto reference = hashes_of(patch, {});
    // A listener that nothing depends on comes, and goes again.
    std::string more =
        with(patch, "wires = [\n", "wires = [\n  \"a.out -> ear.in\",\n  \"b.pose -> ears.path as batch\",\n");
    more += "[nodes.ear]\ntype = \"chaos\"\nrate = \"1 kHz\"\n[nodes.ears]\ntype = \"batch_sum\"\nrate = \"60 Hz\"\n";
    auto edited = hashes_of(patch, {{150 * ms, more}, {300 * ms, patch}});
    CHECK(edited.count("ear.out") == 1);
    for (const auto& [port, hash] : reference) CHECK(edited.at(port) == hash);
}

TEST_CASE("a parameter that the text changes takes effect at the switch and not before") {
    const std::string patch = four_rates();
    const std::string louder = with(patch, "[nodes.b]\n", "[nodes.b]\ngain = 0.5\n");
    const auto reference = hashes_of(patch, {}), changed = hashes_of(patch, {{250 * ms, louder}});
    CHECK(changed.at("b.out") != reference.at("b.out"));
    // Up to the switch, and as long as nothing of it can have arrived, all is the same.
    const auto before = hashes_of(patch, {}, 0.25), same = hashes_of(patch, {{250 * ms, louder}}, 0.25);
    CHECK(same == before);
    // The node itself goes on: with its gain set back there is no trace of the edit.
    CHECK(hashes_of(patch, {{250 * ms, louder}, {250 * ms, patch}}) == reference);
}

TEST_CASE("a node whose structure changes is made anew, and starts as the patch says") {
    const std::string patch = four_rates();
    const std::string reseeded = with(patch, "seed = 7", "seed = 8");
    const auto changed = hashes_of(patch, {{0, reseeded}}), fresh = hashes_of(reseeded, {});
    // Taken over before the first activation, the second plan is all that ever ran.
    for (const auto& [port, hash] : fresh) CHECK(changed.at(port) == hash);
}

TEST_CASE("with edits too, threads and blocks cannot change a bit", "[slow]") {
    std::vector<Edit> edits;
    for (int i = 1; i <= 12; ++i) edits.push_back({i * 37 * ms + i * 1000, edited(static_cast<std::uint64_t>(i))});
    const auto reference = hashes_of(edited(0), edits, 1, 1, false, 0.5);
    for (const int threads : {1, 2, 4})
        for (const int block : {1, 48, 480}) {
            INFO(threads << " threads, blocks of " << block);
            CHECK(hashes_of(edited(0), edits, threads, block, false, 0.5) == reference);
            CHECK(hashes_of(edited(0), edits, threads, block, true, 0.5) == reference);
        }
}

TEST_CASE("edits may follow each other faster than values travel", "[slow]") {
    std::vector<Edit> edits;
    for (int i = 1; i <= 300; ++i) edits.push_back({i * ms + i * 777, edited(static_cast<std::uint64_t>(i % 23))});
    const auto reference = hashes_of(edited(0), edits, 1, 1, false, 0.4);
    CHECK(hashes_of(edited(0), edits, 3, 480, true, 0.4) == reference);
}

TEST_CASE("a storm of edits under load is repeated to the bit from its take", "[virtual][slow]") {
    const VirtualClock clock;
    // TACTUS_STORM=2000 makes it a long one.
    const char* asked = std::getenv("TACTUS_STORM");
    const std::int64_t storm = asked ? std::atoll(asked) : 40;
    const auto folder = scratch("storm");
    std::int64_t told = 0, failed = 0;
    run::Engine::PortHashes live_hashes;
    {
        take::TakeWriter take(
            folder, {.patch_file = "storm.toml", .overrides = {}, .seed = {}, .seconds = 3600.0, .live = true});
        run::EngineOptions options;
        options.seconds = 3600.0;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(edited(0)), options);
        std::atomic<bool> stop{false};
        std::uint64_t next = 0;
        run::LiveOptions live;
        live.stop = &stop;
        live.watch = [&] {
            if (told + failed >= storm) stop = true;
            if (!engine.is_settled() || stop) return;
            const std::string text = edited(++next);
            engine.edit([text] { return compile_text(text); },
                        [&](const run::EditOutcome& outcome) { (outcome.error ? failed : told) += 1; });
            engine.set("b", "gain", fmt::format("{:.4f}", 0.001 * static_cast<double>(next % 900)));
        };
        engine.run_live(live);
        engine.finish();
        live_hashes = engine.port_hashes();
    }
    CHECK(failed == 0);
    CHECK(told >= storm);
    const Repetition again = repeat(folder, 2);
    if (again.difference)
        FAIL(again.difference->port << " differs at tick " << again.difference->tick << ", " << again.difference->time
                                    << " s");
    CHECK(again.compared > 1000);
    CHECK(again.hashes == live_hashes);
    CHECK(again.matches_result);
    std::filesystem::remove_all(folder);
}

TEST_CASE("a run that ends before the first tick of a group that an edit made has its hashes again", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("unborn");
    std::string more = with(four_rates(), "wires = [\n", "wires = [\n  \"a.out -> late.in\",\n");
    more += "[nodes.late]\ntype = \"chaos\"\nrate = \"10 Hz\"\n";
    run::Engine::PortHashes live_hashes;
    {
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 30.0, .live = true});
        run::EngineOptions options;
        options.seconds = 30.0;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(four_rates()), options);
        std::atomic<bool> stop{false};
        bool is_asked = false;
        run::LiveOptions live;
        live.stop = &stop;
        live.watch = [&] {
            if (is_asked || engine.progress_seconds() < 0.05) return;
            is_asked = true;
            engine.edit([&] { return compile_text(more); },
                        [&](const run::EditOutcome& outcome) {
                            CHECK_FALSE(outcome.error);
                            stop = true;
                        });
        };
        engine.run_live(live);
        engine.finish();
        live_hashes = engine.port_hashes();
    }
    const Repetition again = repeat(folder, 2);
    CHECK_FALSE(again.difference);
    CHECK(again.hashes == live_hashes);
    CHECK(again.matches_result);
    std::filesystem::remove_all(folder);
}

TEST_CASE("a parameter set from outside holds two quanta later, and the take repeats it", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("set");
    run::Engine::PortHashes live_hashes;
    Flicks asked_at = 0, holds_at = 0;
    {
        take::TakeWriter take(folder,
                              {.patch_file = "set.toml", .overrides = {}, .seed = {}, .seconds = 0.4, .live = true});
        run::EngineOptions options;
        options.seconds = 0.4;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(four_rates()), options);
        run::LiveOptions live;
        live.watch = [&] {
            if (holds_at != 0 || engine.progress_seconds() < 0.1) return;
            asked_at = static_cast<Flicks>(engine.progress_seconds() * static_cast<double>(flicks_per_second));
            holds_at = engine.set("b", "gain", "0.25");
            CHECK_THROWS_WITH(engine.set("bb", "gain", "1"), Catch::Matchers::ContainsSubstring("did you mean 'b'"));
            CHECK_THROWS_WITH(engine.set("b", "gian", "1"), Catch::Matchers::ContainsSubstring("did you mean 'gain'"));
            CHECK_THROWS_WITH(engine.set("b", "gain", "7"), Catch::Matchers::ContainsSubstring("outside"));
            CHECK_THROWS_WITH(engine.set("loud", "factor", "1"),
                              Catch::Matchers::ContainsSubstring("driven by a wire"));
        };
        engine.run_live(live);
        engine.finish();
        live_hashes = engine.port_hashes();
    }
    CHECK(holds_at >= asked_at + 2 * ms);
    const Repetition again = repeat(folder, 3);
    CHECK_FALSE(again.difference);
    CHECK(again.hashes == live_hashes);
    const auto untouched = hashes_of(four_rates(), {}, 0.4);
    CHECK(std::ranges::any_of(live_hashes, [&](const auto& port) { return untouched.at(port.first) != port.second; }));
    std::filesystem::remove_all(folder);
}

TEST_CASE("setting a parameter of a nested sub-patch sets all that it stands for", "[virtual]") {
    const VirtualClock clock;
    const std::string parts = R"(
[[parts]]
path = "two.toml"
text = '''
wires = [ "x.out -> y.in" ]
[inputs]
in = "x.in"
[outputs]
out = "y.out"
[parameters]
g = ["x.factor", "y.factor"]
[nodes]
x = { type = "gain", rate = "1 kHz" }
y = { type = "gain", rate = "1 kHz" }
'''
[[parts]]
path = "outer.toml"
text = '''
[inputs]
in = "b.in"
[outputs]
out = "b.out"
[parameters]
g = "b.g"
[nodes]
b = { type = "patch:two.toml" }
'''
)";
    run::EngineOptions options;
    options.seconds = 0.3;
    options.live = true;
    run::Engine engine(compile_text(R"(wires = [ "one.value -> n.in", "n.out -> p.in" ]
[nodes]
one = { type = "constant", rate = "1 kHz", number = 1 }
n = { type = "patch:outer.toml", g = 5 }
p = { type = "probe", rate = "1 kHz" }
)" + parts),
                       options);
    const auto factors = [&] {
        std::vector<double> all;
        for (const auto& node : engine.nodes())
            if (const auto found = node->params.find("factor"); found != node->params.end())
                all.push_back(found->second->value);
        return all;
    };
    CHECK(factors() == std::vector{5.0, 5.0});
    bool is_set = false;
    run::LiveOptions live;
    live.watch = [&] {
        if (!is_set) engine.set("n", "g", "9");
        is_set = true;
    };
    engine.run_live(live);
    CHECK(factors() == std::vector{9.0, 9.0});
}

/// Edits a live run `late` times: a group of another rate in each edit, which the next one drops. What `memory` returns
/// after `early` of them and after all, and what the groups have counted.
struct EditedRun {
    std::int64_t early_bytes = 0, late_bytes = 0, ticks = 0;
    int made = 0;
    std::size_t groups = 0;

    EditedRun(int early, int late, std::int64_t (*memory)()) {
        const VirtualClock clock;
        const std::string plain = four_rates();
        const auto with_group = [&](int edit) {
            constexpr std::array rates{120, 125, 150, 250, 400};
            return plain + fmt::format("[nodes.extra]\ntype = \"constant\"\nrate = \"{} Hz\"\n",
                                       rates[static_cast<std::size_t>(edit % 5)]);
        };
        run::EngineOptions options;
        options.seconds = late;
        options.live = true;
        run::Engine engine(compile_text(plain), options);
        std::atomic<bool> stop{false};
        run::LiveOptions live;
        live.stop = &stop;
        bool is_waiting = false;
        live.watch = [&] {
            if (is_waiting || !engine.is_settled()) return;
            if (made == early) early_bytes = memory();
            if (made == late) {
                late_bytes = memory();
                stop = true;
                return;
            }
            is_waiting = true;
            engine.edit([&, edit = made] { return compile_text(with_group(edit)); },
                        [&](const run::EditOutcome& outcome) {
                            CHECK_FALSE(outcome.error);
                            ++made;
                            is_waiting = false;
                        });
        };
        engine.run_live(live);
        for (const auto& group : engine.groups())
            if (group->is_over() && group->plan->name.find("Hz") != std::string::npos) ticks += group->telemetry.ticks;
        groups = engine.groups().size();
    }
};

TEST_CASE("edits that make and drop groups leave no memory behind, and the counts of those groups stay",
          "[virtual][slow]") {
    const EditedRun run(20, 60, [] {
        const auto info = ::mallinfo2();
        return static_cast<std::int64_t>(info.uordblks + info.hblkhd);
    });
    CHECK(run.made == 60);
    CHECK(run.late_bytes - run.early_bytes < 150'000);  // 48 kB an edit would be 1.9 MB
    CHECK(run.ticks > 0);
    CHECK(run.groups < 15);
}

TEST_CASE("10,000 edits take at most 10 MB more than 1,000", "[.]") {
    const EditedRun run(1000, 10'000, [] {
        std::int64_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages >> pages;
        return pages * ::sysconf(_SC_PAGESIZE);
    });
    fmt::print("resident after 1000 edits {:.1f} MB, after 10000 {:.1f} MB\n",
               1e-6 * static_cast<double>(run.early_bytes), 1e-6 * static_cast<double>(run.late_bytes));
    CHECK(run.made == 10'000);
    CHECK(run.late_bytes - run.early_bytes <= 10'000'000);
}

TEST_CASE("an edit that cannot be made leaves the old plan running", "[virtual]") {
    const VirtualClock clock;
    run::EngineOptions options;
    options.seconds = 0.4;
    options.live = true;
    run::Engine engine(compile_text(four_rates()), options);
    std::vector<std::string> errors;
    bool asked = false;
    run::LiveOptions live;
    live.watch = [&] {
        if (asked || engine.progress_seconds() < 0.05) return;
        asked = true;
        engine.edit([]() -> compile::Schedule { throw Error({"test.toml", 3, 4}, "no node 'x'"); },
                    [&](const run::EditOutcome& outcome) {
                        if (outcome.error) errors.push_back(*outcome.error);
                    });
    };
    engine.run_live(live);
    CHECK(errors == std::vector<std::string>{"test.toml:3:4: no node 'x'"});
    CHECK(engine.edits() == 0);
    std::int64_t misses = 0;
    for (const auto& group : engine.groups())
        misses += group->telemetry.misses + group->telemetry.skipped + group->telemetry.dropped;
    if (misses == 0) {
        const auto ports = engine.port_hashes();
        CHECK(std::map<std::string, std::uint64_t>(ports.begin(), ports.end()) == hashes_of(four_rates(), {}, 0.4));
    }
}

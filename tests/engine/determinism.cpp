// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <filesystem>

using namespace tactus;
using namespace tactus::test;

namespace {

std::uint64_t rendered(const std::string& toml, int threads, int block, bool random_blocks, double length = 1.0) {
    run::EngineOptions options;
    options.seconds = length;
    options.block = block;
    options.random_blocks = random_blocks;
    run::Engine engine(compile_text(toml), options);
    engine.render(threads);
    return engine.output_hash();
}

}  // namespace

TEST_CASE("threads and blocks cannot change a bit of the output", "[slow]") {
    const std::string patch = four_rates();
    const std::uint64_t reference = rendered(patch, 1, 1, false);
    for (const int threads : {1, 2, 4})
        for (const int block : {1, 16, 48, 480}) {
            INFO(threads << " threads, blocks of " << block);
            CHECK(rendered(patch, threads, block, false) == reference);
            CHECK(rendered(patch, threads, block, true) == reference);
        }
}

TEST_CASE("another seed gives another output") {
    std::string patch = four_rates();
    const std::uint64_t reference = rendered(patch, 1, 0, false);
    patch.replace(patch.find("seed = 7"), 8, "seed = 8");
    CHECK(rendered(patch, 1, 0, false) != reference);
}

TEST_CASE("every group runs the activations that start before the end, and no more") {
    run::EngineOptions options;
    options.seconds = 0.5;
    run::Engine engine(compile_text(four_rates()), options);
    engine.render(2);
    std::vector<std::int64_t> ticks;
    for (const auto& group : engine.groups()) ticks.push_back(group->telemetry.ticks.load());
    CHECK(ticks == std::vector<std::int64_t>{24000, 500, 75, 30});
    for (const auto& group : engine.groups()) CHECK(group->telemetry.misses.load() == 0);
}

TEST_CASE("a live run that misses nothing has the offline hash, and one that misses has that of its log",
          "[virtual][slow]") {
    const VirtualClock clock;
    const std::string patch = four_rates();
    const std::uint64_t offline = rendered(patch, 1, 0, false, 0.4);
    for (const double dilate : {1.0, 4.0, 16.0}) {
        const auto log = scratch("determinism.log");
        run::EngineOptions options;
        options.seconds = 0.4;
        options.live = true;
        run::Engine live(compile_text(patch), options);
        live.run_live({.dilate = dilate, .log = log, .stop = nullptr, .watch = {}});
        std::int64_t misses = 0;
        for (const auto& group : live.groups())
            misses += group->telemetry.misses + group->telemetry.skipped + group->telemetry.dropped;
        INFO("dilated " << dilate << ", misses " << misses);
        if (misses == 0) CHECK(live.output_hash() == offline);
        const take::TimingLog recorded = take::TimingLog::load(log);
        for (const int threads : {1, 3}) {
            run::EngineOptions again;
            again.seconds = 0.4;
            again.replay = &recorded;
            run::Engine replay(compile_text(patch), again);
            replay.render(threads);
            CHECK(replay.port_hashes() == live.port_hashes());
        }
        std::filesystem::remove(log);
    }
}

TEST_CASE("an overloaded live run skips, drops and holds, and its log still gives the same bits", "[virtual][slow]") {
    // Threads wake late by up to three periods of the fast group, and now and then by two of the slow one.
    const VirtualClock clock({.max_ns = 3'000'000, .rare_fraction = 0.05, .max_rare_ns = 40'000'000});
    const std::string patch = four_rates();
    const auto log = scratch("overload.log");
    run::EngineOptions options;
    options.seconds = 0.3;
    options.live = true;
    run::Engine live(compile_text(patch), options);
    live.run_live({.dilate = 1.0, .log = log, .stop = nullptr, .watch = {}});
    std::int64_t decisions = 0;
    for (const auto& group : live.groups())
        decisions += group->telemetry.misses + group->telemetry.skipped + group->telemetry.dropped;
    CHECK(decisions > 0);
    const take::TimingLog recorded = take::TimingLog::load(log);
    run::EngineOptions again;
    again.seconds = 0.3;
    again.replay = &recorded;
    run::Engine replay(compile_text(patch), again);
    replay.render(2);
    CHECK(replay.port_hashes() == live.port_hashes());
    std::filesystem::remove(log);
}

TEST_CASE("a live run in which groups stand still for longer than rings hold is repeated, whatever blocks and threads",
          "[virtual][slow]") {
    const VirtualClock clock;
    std::string patch = four_rates();
    const auto stand_still = [&patch](const std::string& name, const std::string& rate, int at) {
        patch += "[nodes." + name + "]\ntype = \"planted\"\nrate = \"" + rate +
                 "\"\nfault = \"stall\"\nstall = \"250 ms\"\nat = " + std::to_string(at) + "\n";
        patch.insert(patch.find("\n]\n"), "\n  \"b.pose -> " + name + ".pose\",");
    };
    stand_still("quick", "1 kHz", 150);
    stand_still("loudly", "48 kHz", 30'000);
    stand_still("slowly", "60 Hz", 60);
    const auto log = scratch("standstill.log");
    run::EngineOptions options;
    options.seconds = 1.6;
    options.live = true;
    run::Engine live(compile_text(patch), options);
    live.run_live({.dilate = 1.0, .log = log, .stop = nullptr, .watch = {}});
    std::int64_t skipped = 0;
    for (const auto& group : live.groups()) skipped += group->telemetry.skipped;
    CHECK(skipped > 100);
    check_replays([&] { return compile_text(patch); }, options.seconds, log, live.port_hashes());
    std::filesystem::remove(log);
}

TEST_CASE("a damaged or foreign log is refused", "[virtual]") {
    const VirtualClock clock;
    const auto log = scratch("damaged.log");
    run::EngineOptions options;
    options.seconds = 0.05;
    options.live = true;
    run::Engine live(compile_text(four_rates()), options);
    live.run_live({.dilate = 1.0, .log = log, .stop = nullptr, .watch = {}});
    const auto size = std::filesystem::file_size(log);
    std::filesystem::resize_file(log, size - 4);
    CHECK_THROWS_WITH(take::TimingLog::load(log), Catch::Matchers::ContainsSubstring("stops before the end"));
    std::filesystem::resize_file(log, 10);
    CHECK_THROWS_WITH(take::TimingLog::load(log), Catch::Matchers::ContainsSubstring("not a timing log"));
    std::filesystem::remove(log);
    CHECK_THROWS_WITH(take::TimingLog::load(log), Catch::Matchers::ContainsSubstring("cannot read"));
}

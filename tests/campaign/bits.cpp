// SPDX-License-Identifier: Apache-2.0
// Random patches, each run in 13 variants that must have the same bits: offline, live and in replay.
//     bits [COUNT [FIRST]]
// takes COUNT patches (79) from the seed FIRST on (0), and prints a line for each patch and each difference. Exit code 1: one
// differed. bits 1 SEED repeats one and prints its patch.
#include "tests/engine/random_patches.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <set>
#include <string>

int main(int argc, char** argv) try {
    using namespace tactus;
    constexpr double seconds = 0.5;
    const std::uint64_t count = argc > 1 ? std::stoull(argv[1]) : 79, first = argc > 2 ? std::stoull(argv[2]) : 0;
    fmt::print("{:>6} {:>6} {:>6} {:>10} {:>8} {:>10}\n", "seed", "nodes", "links", "decisions", "changed", "differ");
    int differing = 0, changed = 0, not_compared = 0;
    std::int64_t decisions = 0;
    std::set<std::string> types;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const test::RandomPatch patch = test::random_patch(seed);
        const test::ComparedRuns runs = test::compare_runs(patch.toml, seconds, seed);
        fmt::print("{:>6} {:>6} {:>6} {:>10} {:>8} {:>10}\n", seed, patch.nodes, patch.links, runs.decisions,
                   runs.has_changed ? "yes" : "no", runs.differences.size());
        for (const std::string& difference : runs.differences) fmt::print("    {}\n", difference);
        if (count == 1) fmt::print("{}", patch.toml);
        std::fflush(stdout);
        differing += !runs.differences.empty();
        changed += runs.has_changed;
        not_compared += runs.missed > 0;
        decisions += runs.decisions;
        types.insert(patch.types.begin(), patch.types.end());
    }
    fmt::print(
        "{} patches of {} node types in {} variants: {} differ. Late threads made {} decisions and changed the bits of "
        "{} "
        "patches; {} live runs on time were late all the same. {:.0f} s of processor time\n",
        count, types.size(), test::run_variants, differing, decisions, changed, not_compared,
        static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
    return differing > 0 || (count > 10 && decisions == 0) ? 1 : 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "bits: {}\n", error.what());
    return 2;
}

// SPDX-License-Identifier: Apache-2.0
// Few of the patches of ./dev bits.
#include "graph/node/node.hpp"
#include "nodes/catalogue.hpp"
#include "tests/engine/random_patches.hpp"
#include "tests/support/catch.hpp"

#include <cstdint>
#include <set>
#include <string>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("random patches have the same bits offline, live and in replay, whatever threads and blocks",
          "[virtual][long]") {
    std::int64_t decisions = 0;
    bool has_changed = false;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        const RandomPatch patch = random_patch(seed);
        const ComparedRuns runs = compare_runs(patch.toml, 0.3, seed);
        CAPTURE(seed, patch.toml);
        for (const std::string& difference : runs.differences) FAIL_CHECK(difference);
        decisions += runs.decisions;
        has_changed = has_changed || runs.has_changed;
    }
    CHECK(decisions > 100);
    CHECK(has_changed);
}

TEST_CASE("random patches differ by their seed and hold most node types that need no file") {
    std::set<std::string> types, texts;
    int links = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const RandomPatch patch = random_patch(seed);
        CHECK(patch.nodes >= 8);
        types.insert(patch.types.begin(), patch.types.end());
        texts.insert(patch.toml);
        links += patch.links;
    }
    CHECK(texts.size() == 20);
    CHECK(types.size() > 60);
    CHECK(links > 100);
    CHECK(random_patch(3).toml == random_patch(3).toml);
}

// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/sweep_statistics.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <vector>

using namespace tactus;

namespace {

std::vector<double> ranks_to(std::size_t count) {
    std::vector<double> ranks;
    for (std::size_t i = 1; i <= count; ++i) ranks.push_back(static_cast<double>(i));
    return ranks;
}

}  // namespace

TEST_CASE("a median of fewer than six values has no 95 % interval") {
    for (std::size_t n = 0; n < 6; ++n) CHECK_FALSE(analysis::median_interval(ranks_to(n)));
}

TEST_CASE("the interval of a median has the ranks of the tables") {
    // Ranks of 95 % intervals: Hahn and Meeker (1991), Conover (1999).
    const std::tuple<std::size_t, double, double> known[] = {{6, 1, 6},   {8, 1, 8},   {9, 2, 8},   {10, 2, 9},
                                                             {15, 4, 12}, {20, 6, 15}, {25, 8, 18}, {100, 40, 61}};
    for (const auto& [count, low, high] : known) {
        CAPTURE(count);
        CHECK(analysis::median_interval(ranks_to(count)) == std::pair(low, high));
    }
    // Where the normal approximation takes over, the ranks go on without a jump.
    const auto before = *analysis::median_interval(ranks_to(1000)), after = *analysis::median_interval(ranks_to(1002));
    CHECK(after.first >= before.first);
    CHECK(after.first - before.first <= 2.0);
}

TEST_CASE("the interval of a median contains it in 95 % of samples or more") {
    std::uint64_t next = 0;
    const Random random{7};
    for (const std::size_t count : {6u, 7u, 11u, 30u}) {
        CAPTURE(count);
        int hits = 0;
        constexpr int samples = 4000;
        for (int s = 0; s < samples; ++s) {
            std::vector<double> values(count);
            for (double& v : values) v = random.uniform(next++);
            std::ranges::sort(values);
            const auto interval = *analysis::median_interval(values);
            hits += interval.first <= 0.5 && 0.5 <= interval.second;
        }
        CHECK(hits >= samples * 0.94);
    }
}

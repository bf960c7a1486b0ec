// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/adjustment.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <vector>

using namespace tactus;
using namespace tactus::psychophysics;

TEST_CASE("a match by adjustment is the mean of both directions, however many trials each has") {
    const auto result =
        adjusted_level(std::vector{1.0, 1.2, 2.0, 2.2, 2.4, 2.6}, {false, false, true, true, true, true});
    REQUIRE(result);
    CHECK(result->below == Approx(1.1));
    CHECK(result->above == Approx(2.3));
    CHECK(result->match == Approx(1.7));  // not 1.9, the mean of all
    CHECK(result->below_count == 2);
    CHECK(result->above_count == 4);
    // Sums of squares 0.02 and 0.2 on 4 degrees of freedom.
    CHECK(result->deviation == Approx(0.2345208));
    CHECK(result->interval.high - result->match == Approx(0.5 * 0.2345208 * 0.8660254 * 2.776445).epsilon(1e-5));
}

TEST_CASE("one direction alone gives no match") {
    CHECK_FALSE(adjusted_level(std::vector{1.0, 1.1, 1.2}, {true, true, true}));
    CHECK_FALSE(adjusted_level(std::vector{1.0, 1.1}, {true, false}));
    CHECK_FALSE(adjusted_level({}, {}));
    // Matches that are equal have an interval without width.
    const auto equal = adjusted_level(std::vector{1.0, 1.0, 1.0, 1.0}, {true, false, true, false});
    REQUIRE(equal);
    CHECK(equal->interval.low == 1.0);
    CHECK(equal->interval.high == 1.0);
}

TEST_CASE("intervals of matches cover the level that is matched, whatever the lag") {
    int covered = 0;
    constexpr int subjects = 2000;
    for (int subject = 0; subject < subjects; ++subject) {
        const Random random{static_cast<std::uint64_t>(subject)};
        std::vector<double> matches;
        std::vector<bool> above;
        for (std::uint64_t trial = 0; trial < 8; ++trial) {
            above.push_back(trial % 2 == 1);
            matches.push_back(-0.6 + (above.back() ? 0.1 : -0.1) + 0.05 * random.normal(trial));
        }
        const auto result = adjusted_level(matches, above);
        REQUIRE(result);
        covered += result->interval.low <= -0.6 && -0.6 <= result->interval.high ? 1 : 0;
    }
    // Three and a half standard errors.
    CHECK(covered / double{subjects} == Approx(0.95).margin(0.017));
}

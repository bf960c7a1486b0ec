// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/proportion.hpp"
#include "tests/support/catch.hpp"

using namespace tactus::statistics;

TEST_CASE("Wilson's interval has the limits that Newcombe printed") {
    // Newcombe 1998, table I: method 3, without continuity correction.
    const auto check = [](std::size_t r, std::size_t n, double low, double high) {
        const auto found = wilson_interval(r, n);
        CHECK(found.first == Approx(low).margin(5e-5));
        CHECK(found.second == Approx(high).margin(5e-5));
    };
    check(81, 263, 0.2553, 0.3662);
    check(15, 148, 0.0624, 0.1605);
    check(0, 20, 0.0, 0.1611);
    check(1, 29, 0.0061, 0.1718);
    CHECK(wilson_interval(20, 20).second == 1.0);
    CHECK(wilson_interval(0, 0) == std::pair(0.0, 1.0));
}

TEST_CASE("the interval of a paired difference has the limits that Newcombe printed") {
    // Newcombe 1998, paired, table II: method 10.
    const auto [low, high] = paired_difference_interval({36, 12, 2, 0});
    CHECK(low == Approx(0.0569).margin(5e-5));
    CHECK(high == Approx(0.3404).margin(5e-5));
    // The other way round, and where no pair differs: an interval all the same.
    const auto turned = paired_difference_interval({36, 2, 12, 0});
    CHECK(turned.first == Approx(-high));
    CHECK(turned.second == Approx(-low));
    const auto equal = paired_difference_interval({93, 0, 0, 0});
    CHECK(equal.first == Approx(-0.0397).margin(5e-5));
    CHECK(equal.second == Approx(0.0397).margin(5e-5));
    CHECK(paired_difference_interval({0, 30, 0, 0}).second == 1.0);
    CHECK(paired_difference_interval({}) == std::pair(-1.0, 1.0));
}

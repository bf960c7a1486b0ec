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

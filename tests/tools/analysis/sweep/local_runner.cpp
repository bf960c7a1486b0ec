// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/local_runner.hpp"

#include "tests/support/catch.hpp"

#include <vector>

using namespace tactus::analysis;

TEST_CASE("memory that running points have not taken yet is reserved for them") {
    constexpr double gigabyte = 1e9;
    const std::vector<double> none, empty{0.0}, half{0.5 * gigabyte}, full{gigabyte, gigabyte};
    CHECK(fits_in_memory(1.2 * gigabyte, gigabyte, none, 0.0));
    CHECK_FALSE(fits_in_memory(1.05 * gigabyte, gigabyte, none, 0.0));
    // A worker that was just started has taken nothing of what it will need.
    CHECK_FALSE(fits_in_memory(1.2 * gigabyte, gigabyte, empty, 0.0));
    CHECK(fits_in_memory(2.2 * gigabyte, gigabyte, empty, 0.0));
    CHECK_FALSE(fits_in_memory(1.5 * gigabyte, gigabyte, half, 0.0));
    CHECK(fits_in_memory(1.7 * gigabyte, gigabyte, half, 0.0));
    // What they have taken is missing from what is available.
    CHECK(fits_in_memory(1.2 * gigabyte, gigabyte, full, 0.0));
    // An idle worker uses its own memory again.
    CHECK(fits_in_memory(0.3 * gigabyte, gigabyte, none, 0.9 * gigabyte));
    CHECK_FALSE(fits_in_memory(0.05 * gigabyte, gigabyte, none, 3.0 * gigabyte));
}

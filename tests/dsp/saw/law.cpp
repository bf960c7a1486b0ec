// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/cutting_law.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("teeth that are twice as sharp take the same depth under half the thrust") {
    const saw::CuttingLaw law, sharp = law.sharpened(2.0);
    for (const double depth : {0.0, 1e-6, 2e-6, 5e-6, 10e-6})
        CHECK(sharp.thrust(depth) == Approx(0.5 * law.thrust(depth)));
    for (const double thrust : {0.2, 1.0, 3.0, 4.0})
        CHECK(sharp.depth(thrust).depth == Approx(law.depth(2.0 * thrust).depth));
    CHECK(sharp.along(3.0) == Approx(0.5 * law.along(6.0)));
}

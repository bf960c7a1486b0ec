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

TEST_CASE("a tooth cuts nothing up to the thrust that rubs, and no deeper than the deepest cut") {
    const saw::CuttingLaw law;
    for (const double thrust : {-5.0, 0.0, 0.5 * law.rub, law.rub}) {
        CHECK(law.depth(thrust).depth == 0.0);
        CHECK(law.depth(thrust).slope == 0.0);
    }
    for (const double depth : {0.5e-6, 2e-6, 5e-6, 15e-6, 19.9e-6})
        CHECK(law.depth(law.thrust(depth)).depth == Approx(depth));
    for (const double times : {1.01, 2.0, 100.0}) {
        CHECK(law.depth(times * law.thrust(law.deepest)).depth == law.deepest);
        CHECK(law.depth(times * law.thrust(law.deepest)).slope == 0.0);
    }
}

TEST_CASE("the force along the path grows in proportion up to the shallow cut and is constant beyond it") {
    const saw::CuttingLaw law;
    CHECK(law.along(0.5 * law.thrust_shallow) == Approx(0.5 * law.cutting));
    for (const double times : {1.0, 1.2, 10.0}) CHECK(law.along(times * law.thrust_shallow) == Approx(law.cutting));
}

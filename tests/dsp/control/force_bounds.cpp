// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/force_bounds.hpp"

#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tactus;
using namespace tactus::control;

TEST_CASE("a bound shortens a force of any size and keeps its direction, and none of nonsense is left") {
    const ForceBounds bounds{3.0, 0.2};
    const Vec3 direction = glm::normalize(Vec3(1.0, -2.0, 0.5));
    for (const double size : {0.0, 1e-300, 1.0, 2.999, 3.001, 1e6, 1e200, 1e308}) {
        CAPTURE(size);
        const Wrench given = bounds.clamp({direction * size, direction * size});
        CHECK(glm::length(given.force) == Approx(std::min(size, 3.0)).margin(1e-100));
        CHECK(glm::length(given.torque) == Approx(std::min(size, 0.2)).margin(1e-100));
        if (size > 1.0) CHECK(glm::dot(given.force, direction) == Approx(glm::length(given.force)));
        CHECK(glm::length(stated_bounds(0.0, 0.0).clamp({direction, {}}).force) == Approx(1.0));
        CHECK(glm::length(ForceBounds{0.0, 0.0}.clamp({direction * size, {}}).force) == 0.0);
    }
    for (const double nonsense : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK(bounds.clamp({{1.0, nonsense, 0.0}, {}}).force == Vec3(0.0));
        CHECK(bounds.clamp({{1.0, 0.0, 0.0}, {0.0, 0.0, nonsense}}).force == Vec3(0.0));
    }
}

TEST_CASE("a fade begins with the whole force, never grows and ends at its length") {
    CHECK(fade_left(-1.0, 10.0) == 1.0);
    double last = 1.0;
    for (double age = 0.0; age <= 12.0; age += 0.01) {
        const double left = fade_left(age, 10.0);
        REQUIRE(left <= last);
        last = left;
    }
    CHECK(fade_left(5.0, 10.0) == 0.5);
    CHECK(fade_left(10.0, 10.0) == 0.0);
    CHECK(fade_left(0.0, 0.0) == 0.0);
    // The rounding of a sum of ticks adds no tick.
    for (const double period : {1e-3, 1.0 / 3000.0, 2.5e-4})
        for (int ticks = 1; ticks <= 60; ++ticks) {
            double age = 0.0;
            for (int i = 0; i < ticks; ++i) age += period;
            CAPTURE(period, ticks);
            CHECK(fade_left(age, ticks * period) == 0.0);
        }
}

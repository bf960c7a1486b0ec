// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/shape.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

template <class Shape>
void check_points(const Shape& shape, double spacing, double area) {
    double sum = 0.0;
    for (const contact::SurfacePoint& p : shape.points(spacing)) {
        CHECK(std::abs(shape.distance(p.position)) < 1e-12);
        // A step out along the normal is out, a step in is in; on a rim the normal is one of its faces'.
        CHECK(shape.distance(p.position + 1e-6 * p.normal) > 0.5e-6);
        CHECK(glm::length(p.normal) == Approx(1.0));
        sum += p.area;
    }
    CHECK(sum == Approx(area).epsilon(0.03));
}

}  // namespace

TEST_CASE("points of a shape lie on its surface, look outwards and share out its area") {
    check_points(contact::Ball{0.01}, 0.5e-3, 4.0 * pi * 1e-4);
    check_points(contact::Box{{0.02, 0.01, 0.005}}, 0.5e-3, 2.0 * (2e-4 + 1e-4 + 0.5e-4));
    check_points(contact::make_cylinder(0.01, 0.02), 0.4e-3, pi * 0.01 * 0.02 + 2.0 * pi * 25e-6);
    check_points(contact::make_bushing(0.01, 0.03, 0.02), 0.4e-3,
                 pi * 0.01 * 0.02 + pi * 0.03 * 0.02 + 2.0 * pi * (225e-6 - 25e-6));
}

TEST_CASE("distances of turned shapes are those of their profile") {
    const contact::Revolved peg = contact::make_cylinder(0.01, 0.02, 1e-3);
    CHECK(peg.distance({0.0, 0.0, 0.01}) == Approx(-0.005));
    CHECK(peg.distance({0.007, 0.0, 0.01}) == Approx(0.002));
    CHECK(peg.distance({0.0, 0.0, -0.003}) == Approx(0.003));
    CHECK(peg.distance({0.0, 0.005, 0.0}) == Approx(1e-3 / std::sqrt(2.0)));
    const contact::Revolved hole = contact::make_bushing(0.01, 0.03, 0.02, 1e-3);
    CHECK(hole.distance({0.0, 0.0, -0.01}) == Approx(0.005));
    CHECK(hole.distance({0.0, 0.0, 0.01}) == Approx(std::hypot(0.006, 0.01)));
    CHECK(hole.distance({0.01, 0.0, -0.01}) == Approx(-0.005));
    CHECK(hole.distance({0.0055, 0.0, 0.0}) == Approx(0.5e-3 / std::sqrt(2.0)));
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/ruler.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <numbers>

using namespace tactus;

TEST_CASE("dsp: lengths add up along picked points, angles are right down to a microradian") {
    const std::array points{Vec3(0.0), Vec3(0.03, 0.04, 0.0), Vec3(0.03, 0.04, 0.12)};
    CHECK(display::path_length(points) == Approx(0.17));
    CHECK(display::path_length(std::span(points).first(1)) == 0.0);
    CHECK(*display::angle_at(points[1], points[0], points[2]) == Approx(std::numbers::pi / 2.0));
    CHECK(*display::angle_at({0, 0, 0}, {1, 0, 0}, {1, 1e-6, 0}) == Approx(1e-6));
    CHECK(*display::angle_at({0, 0, 0}, {1, 0, 0}, {-1, 1e-6, 0}) == Approx(std::numbers::pi - 1e-6).epsilon(1e-12));
    CHECK_FALSE(display::angle_at(points[0], points[0], points[1]));
}

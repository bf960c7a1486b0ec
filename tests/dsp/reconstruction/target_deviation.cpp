// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/target_deviation.hpp"
#include "dsp/core/constants.hpp"
#include "tests/dsp/reconstruction/donors.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;
using namespace tactus::reconstruction;

namespace {

constexpr double donor_radius = 7.0 * mm, target_radius = 9.0 * mm, aside = 2.0 * mm;

/// One segment of 40 mm along x; the donor is a tube along z with a marrow cavity.
FibulaInputs one_segment() {
    FibulaInputs inputs;
    inputs.planes = {{Vec3(0.0), Vec3(1.0, 0.0, 0.0), {}}, {Vec3(40.0 * mm, 0.0, 0.0), Vec3(1.0, 0.2, 0.0), {}}};
    inputs.line_point = Vec3(100.0 * mm, 0.0, 0.0);
    geometry::TriangleSurface bone =
        closed_tube(inputs.line_point, Vec3(0.0, 0.0, 1.0), 0.3, 60, 121, [](double, double) { return donor_radius; });
    geometry::TriangleSurface marrow = tube_of(inputs.line_point + Vec3(0.0, 0.0, 5.0 * mm), Vec3(0.0, 0.0, 1.0), 0.29,
                                               40, 121, [](double, double) { return 0.5 * donor_radius; });
    for (auto& t : marrow.triangles) std::swap(t[1], t[2]);
    append(bone, marrow);
    inputs.donor = std::move(bone);
    return inputs;
}

/// A tube along x, `aside` from the segment.
DeviationTarget tube_target(double from, double length) {
    return DeviationTarget(closed_tube(Vec3(from, aside, 0.0), Vec3(1.0, 0.0, 0.0), length, 80, 161,
                                       [](double, double) { return target_radius; }));
}

SegmentDeviation deviation_from(const DeviationTarget& target) {
    const FibulaInputs inputs = one_segment();
    return deviation_of(inputs, plan_fibula(inputs), target).at(0);
}

}  // namespace

TEST_CASE("curve and contour of a segment beside a tube deviate as two cylinders do") {
    const SegmentDeviation found = deviation_from(tube_target(-40.0 * mm, 120.0 * mm));
    REQUIRE(found.curve);
    CHECK(found.curve->rms == Approx(aside).epsilon(0.01));
    CHECK(found.curve->greatest == Approx(aside).epsilon(0.02));
    REQUIRE(found.contour);
    double squares = 0.0;
    constexpr int count = 3600;
    for (int n = 0; n < count; ++n) {
        const double turn = 2.0 * pi * n / count;
        const double from_axis = std::hypot(donor_radius * std::cos(turn), donor_radius * std::sin(turn) + aside);
        squares += (from_axis - target_radius) * (from_axis - target_radius) / count;
    }
    CHECK(found.contour->rms == Approx(std::sqrt(squares)).margin(0.1 * mm));
    CHECK(found.contour->lowest == Approx(donor_radius - aside - target_radius).margin(0.15 * mm));
    CHECK(found.contour->highest == Approx(donor_radius + aside - target_radius).margin(0.15 * mm));
    CHECK(found.contour->share == Approx(1.0).margin(0.01));
}

TEST_CASE("a target that ends before the middle of a segment has no curve to deviate from") {
    const SegmentDeviation found = deviation_from(tube_target(-40.0 * mm, 55.0 * mm));
    CHECK_FALSE(found.curve);
    REQUIRE(found.contour);
    CHECK(found.contour->share > 0.3);
    CHECK(found.contour->share < 0.9);
    const SegmentDeviation beyond = deviation_from(tube_target(100.0 * mm, 50.0 * mm));
    CHECK_FALSE(beyond.curve);
    CHECK_FALSE(beyond.contour);
}

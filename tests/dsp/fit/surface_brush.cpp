// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/surface_brush.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

using namespace tactus;

namespace {

/// Points of a crumpled sheet, some of them painted.
std::vector<contact::SurfacePoint> sheet(int side) {
    const Random random{5};
    std::vector<contact::SurfacePoint> points;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const auto n = static_cast<std::uint64_t>(j * side + i);
            const Vec3 at = Vec3(0.4 * i, 0.4 * j, random.normal(n)) * mm;
            const bool is_painted = random.uniform(n + 1'000'000) < 0.1;
            points.push_back({at, Vec3(0.0, 0.0, 1.0), 0.16 * mm * mm,
                              is_painted ? contact::surface_label::fracture : contact::surface_label::none});
        }
    return points;
}

}  // namespace

TEST_CASE("strokes of any size, on and off the surface, label what a look at every point would") {
    std::vector<contact::SurfacePoint> points = sheet(120);
    fit::SurfaceBrush brush(points);
    const Random random{9};
    for (std::uint64_t n = 0; n < 300; ++n) {
        const Vec3 at =
            Vec3(random.uniform(4 * n) * 60.0 - 6.0, random.uniform(4 * n + 1) * 60.0 - 6.0, random.normal(4 * n + 2)) *
            mm;
        const double radius = (n % 50 == 0 ? 40.0 : 0.2 + 4.0 * random.uniform(4 * n + 3)) * mm;
        const std::uint8_t label = n % 3 == 0 ? contact::surface_label::none : contact::surface_label::fracture;
        brush.stroke(at, radius, label);
        double least = fit::SurfaceBrush::farthest;
        std::size_t labelled = 0;
        double area = 0.0;
        for (contact::SurfacePoint& p : points) {
            const Vec3 difference = p.position - at;
            if (glm::dot(difference, difference) <= radius * radius) p.label = label;
            least = std::min(least, glm::length(difference));
            if (p.label == contact::surface_label::none) continue;
            ++labelled;
            area += p.area;
        }
        REQUIRE(std::ranges::equal(brush.points(), points, {}, &contact::SurfacePoint::label,
                                   &contact::SurfacePoint::label));
        REQUIRE(brush.labelled() == labelled);
        REQUIRE(brush.area() == Approx(area).margin(1e-12));
        REQUIRE(brush.distance(at) == Approx(least).margin(1e-12));
    }
}

TEST_CASE("a brush far away meets nothing, and neither does one on a surface without points") {
    fit::SurfaceBrush brush(sheet(10));
    const std::size_t before = brush.labelled();
    brush.stroke(Vec3(0.5, 0.0, 0.0), 10.0 * mm, contact::surface_label::fracture);
    CHECK(brush.labelled() == before);
    CHECK(brush.distance(Vec3(0.5, 0.0, 0.0)) == fit::SurfaceBrush::farthest);
    fit::SurfaceBrush none({});
    none.stroke(Vec3(0.0), 10.0 * mm, contact::surface_label::fracture);
    CHECK(none.labelled() == 0);
    CHECK(none.distance(Vec3(0.0)) == fit::SurfaceBrush::farthest);
}

TEST_CASE("a brush neither paints nor erases what is as scanned, and does not count it") {
    std::vector<contact::SurfacePoint> points;
    for (int n = 0; n < 10; ++n)
        points.push_back({Vec3(n * mm, 0.0, 0.0), Vec3(0.0, 0.0, 1.0), 1e-6,
                          n < 4 ? contact::surface_label::as_scanned : contact::surface_label::none});
    fit::SurfaceBrush brush(points);
    CHECK(brush.labelled() == 0);
    brush.stroke(Vec3(0.0), 100.0 * mm, contact::surface_label::fracture);
    CHECK(brush.labelled() == 6);
    CHECK(brush.area() == Approx(6e-6));
    brush.stroke(Vec3(0.0), 100.0 * mm, contact::surface_label::none);
    CHECK(brush.labelled() == 0);
    for (std::size_t n = 0; n < 4; ++n) CHECK(brush.points()[n].label == contact::surface_label::as_scanned);
}

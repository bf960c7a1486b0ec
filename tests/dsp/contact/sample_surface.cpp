// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/sample_surface.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/support/catch.hpp"

#include <numeric>

using namespace tactus;

namespace {

/// Distance to a box of half sides `half` with sharp edges.
volume::Grid box(int size, double spacing, const Vec3& half) {
    return contact::sample_voxmap(contact::centred_layout(size, spacing),
                                  [half](const Vec3& p) {
                                      const Vec3 q = glm::abs(p) - half;
                                      const double outside = glm::length(glm::max(q, Vec3(0.0)));
                                      return outside + std::min(std::max({q.x, q.y, q.z}), 0.0);
                                  })
        .grid;
}

double total_area(const std::vector<contact::SurfacePoint>& points) {
    return std::accumulate(points.begin(), points.end(), 0.0,
                           [](double a, const contact::SurfacePoint& p) { return a + p.area; });
}

/// Distance from each point to the nearest other.
std::vector<double> nearest_of(const std::vector<contact::SurfacePoint>& points) {
    std::vector<double> nearest(points.size(), 1.0);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < points.size(); ++j)
            if (i != j) nearest[i] = std::min(nearest[i], glm::length(points[i].position - points[j].position));
    return nearest;
}

}  // namespace

TEST_CASE("points on a ball lie on it, evenly, one per spacing², and their areas add up to its surface") {
    const double radius = 0.012, spacing = 0.8e-3, area = 4.0 * pi * radius * radius;
    const auto points = contact::sample_surface(bodies::ball(60, 0.5e-3, radius).grid, {.spacing = spacing});
    CHECK(static_cast<double>(points.size()) == Approx(area / (spacing * spacing)).epsilon(0.1));
    CHECK(total_area(points) == Approx(area).epsilon(0.005));
    double worst_angle = 0.0, worst_height = 0.0;
    for (const contact::SurfacePoint& p : points) {
        worst_height = std::max(worst_height, std::abs(glm::length(p.position) - radius));
        worst_angle = std::max(worst_angle, glm::length(p.normal - glm::normalize(p.position)));
        // No point stands for far more or less than its neighbours.
        CHECK(p.area > 0.3 * spacing * spacing);
        CHECK(p.area < 2.5 * spacing * spacing);
    }
    CHECK(worst_height < 0.02 * 0.5e-3);
    CHECK(worst_angle < 0.01);
    const auto nearest = nearest_of(points);
    CHECK(*std::ranges::min_element(nearest) > 0.75 * spacing);
    CHECK(*std::ranges::max_element(nearest) < 1.5 * spacing);
}

TEST_CASE("a thin plate has its points on both sides") {
    const volume::Grid plate = box(60, 0.5e-3, Vec3(0.01, 0.01, 0.4e-3));
    const auto points = contact::sample_surface(plate, {.spacing = 1e-3});
    const auto above = std::ranges::count_if(points, [](const contact::SurfacePoint& p) { return p.normal.z > 0.9; });
    const auto below = std::ranges::count_if(points, [](const contact::SurfacePoint& p) { return p.normal.z < -0.9; });
    // 400 mm² a side.
    CHECK(above > 340);
    CHECK(below > 340);
    for (const contact::SurfacePoint& p : points)
        if (std::abs(p.normal.z) > 0.9) CHECK(p.normal.z * p.position.z > 0.0);
}

TEST_CASE("following curvature, points crowd where the surface turns and nowhere else") {
    const volume::Grid grid = box(60, 0.4e-3, Vec3(0.008));
    const auto even = contact::sample_surface(grid, {.spacing = 1e-3});
    const auto crowded = contact::sample_surface(grid, {.spacing = 1e-3, .follow_curvature = true});
    const auto count = [](const std::vector<contact::SurfacePoint>& points, bool near_edge) {
        return std::ranges::count_if(points, [&](const contact::SurfacePoint& p) {
            Vec3 a = glm::abs(p.position);
            if (a.x < a.y) std::swap(a.x, a.y);
            if (a.x < a.z) std::swap(a.x, a.z);
            // The turn is seen from one spacing away, and the field rounds the edge by a cell.
            return (std::max(a.y, a.z) > 0.0065) == near_edge;
        });
    };
    CHECK(count(crowded, true) > 1.8 * count(even, true));
    CHECK(static_cast<double>(count(crowded, false)) == Approx(count(even, false)).epsilon(0.15));
    CHECK(total_area(crowded) == Approx(total_area(even)).epsilon(0.01));
}

TEST_CASE("the same surface gives the same points, and a mesh will do as well as a grid") {
    const volume::Grid grid = bodies::ball(40, 0.5e-3, 0.008).grid;
    const contact::SurfaceSampling sampling{.spacing = 0.7e-3};
    const auto a = contact::sample_surface(grid, sampling), b = contact::sample_surface(grid, sampling);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a[i].position == b[i].position);
        CHECK(a[i].area == b[i].area);
    }
    // Two triangles of a square, seen from above.
    const geometry::TriangleSurface square{{Vec3(0, 0, 0), Vec3(0.02, 0, 0), Vec3(0.02, 0.02, 0), Vec3(0, 0.02, 0)},
                                           {{0, 1, 2}, {0, 2, 3}}};
    const auto flat = contact::sample_surface(square, {.spacing = 1e-3});
    CHECK(flat.size() == Approx(400).epsilon(0.12));
    CHECK(total_area(flat) == Approx(4e-4));
    for (const contact::SurfacePoint& p : flat) CHECK(p.normal == Vec3(0, 0, 1));
}

TEST_CASE("sampling refuses what it cannot do and gives nothing where nothing is") {
    const volume::Grid grid = bodies::ball(20, 0.5e-3, 0.004).grid;
    CHECK_THROWS_AS(contact::sample_surface(grid, {.spacing = 0.0}), Error);
    CHECK_THROWS_AS(contact::sample_surface(grid, {.spacing = -1.0}), Error);
    CHECK_THROWS_AS(contact::sample_surface(grid, {.spacing = 1e-7}), Error);
    CHECK_THROWS_AS(contact::sample_surface(grid, {.spacing = 0.5e-3, .max_points = 10}), Error);
    CHECK(contact::sample_surface(geometry::TriangleSurface{}, {}).empty());
    CHECK(contact::sample_surface(
              contact::sample_voxmap(contact::centred_layout(8, 1e-3), [](const Vec3&) { return 1.0; }).grid, {})
              .empty());
}

TEST_CASE("points that face another body are labelled, those that look away are not") {
    // A block on another, 0.3 mm apart.
    auto points = contact::sample_surface(box(60, 0.5e-3, Vec3(0.008)), {.spacing = 1e-3});
    const contact::Voxmap other = contact::make_voxmap(box(60, 0.5e-3, Vec3(0.008)));
    const Pose into{Vec3(0.0, 0.0, 0.0163), Quat(1, 0, 0, 0)};
    const std::size_t labelled = contact::label_facing(points, other, into, 0.6e-3, 0.7);
    CHECK(labelled > 200);
    std::size_t seen = 0;
    for (const contact::SurfacePoint& p : points) {
        if (p.label != contact::surface_label::fracture) continue;
        ++seen;
        CHECK(p.normal.z < -0.6);
        CHECK(p.position.z < -0.007);
    }
    CHECK(seen == labelled);
}

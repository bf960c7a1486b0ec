// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/iso_distance.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/volume/components.hpp"
#include "dsp/volume/resample.hpp"
#include "dsp/volume/surface_distance.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

using namespace tactus;

namespace {

volume::Grid cube_grid(int size, double spacing) {
    volume::Grid grid{{size, size, size}, Vec3(-0.5 * (size - 1) * spacing), Vec3(spacing), {}};
    grid.values.assign(grid.count(), 0.0f);
    return grid;
}

// Each voxel holds the share of its volume that lies in the sphere, from 6³ points, between air and bone.
volume::Grid partial_volume_sphere(double radius, double voxel, const Vec3& centre, int size) {
    volume::Grid grid = cube_grid(size, voxel);
    for (int k = 0; k < size; ++k)
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) {
                int inside = 0;
                for (int n = 0; n < 216; ++n) {
                    const Vec3 part((n % 6 - 2.5) / 6.0, (n / 6 % 6 - 2.5) / 6.0, (n / 36 - 2.5) / 6.0);
                    const Vec3 offset = grid.position(i, j, k) + part * voxel - centre;
                    inside += glm::dot(offset, offset) < radius * radius;
                }
                grid.at(i, j, k) = static_cast<float>(-1000.0 + 2600.0 * inside / 216.0);
            }
    return grid;
}

double percentile_95(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() * 95 / 100];
}

struct Errors {
    double depth, direction;
};

// 95th percentiles over samples within two voxels: depth in m, direction of the central-difference gradient in degrees.
Errors sphere_errors(const volume::Grid& distance, double radius, const Vec3& centre) {
    std::vector<double> depth, direction;
    const double voxel = distance.spacing.x;
    for (int k = 1; k + 1 < distance.size[2]; ++k)
        for (int j = 1; j + 1 < distance.size[1]; ++j)
            for (int i = 1; i + 1 < distance.size[0]; ++i) {
                const Vec3 offset = distance.position(i, j, k) - centre;
                const double exact = glm::length(offset) - radius;
                if (std::abs(exact) > 2.0 * voxel) continue;
                const Vec3 gradient(distance.at(i + 1, j, k) - distance.at(i - 1, j, k),
                                    distance.at(i, j + 1, k) - distance.at(i, j - 1, k),
                                    distance.at(i, j, k + 1) - distance.at(i, j, k - 1));
                depth.push_back(std::abs(distance.at(i, j, k) - exact));
                const double cosine = glm::dot(glm::normalize(gradient), glm::normalize(offset));
                direction.push_back(std::acos(std::min(1.0, cosine)) * 180.0 / std::numbers::pi);
            }
    return {percentile_95(depth), percentile_95(direction)};
}

}  // namespace

TEST_CASE("distance to a partial-volume sphere of 0.35 mm voxels is right within 0.05 mm and 2 degrees") {
    const Vec3 centre(0.11 * mm, -0.07 * mm, 0.05 * mm);
    for (const double radius : {4.0 * mm, 7.3 * mm}) {
        const volume::Grid grey = partial_volume_sphere(radius, 0.35 * mm, centre, radius > 5.0 * mm ? 52 : 34);
        const Errors errors =
            sphere_errors(volume::distance_to_iso(volume::smoothed(volume::smoothed(volume::smoothed(grey))), 300.0f),
                          radius, centre);
        CAPTURE(radius, errors.depth / mm, errors.direction);
        // 300 HU is the half-way value of air at -1000 and bone at 1600.
        CHECK(errors.depth < 0.05 * mm);
        CHECK(errors.direction < 2.0);
    }
}

TEST_CASE("the distance to a smooth sphere stays within a tenth of a voxel everywhere") {
    volume::Grid grey = cube_grid(48, 0.5 * mm);
    for (int k = 0; k < 48; ++k)
        for (int j = 0; j < 48; ++j)
            for (int i = 0; i < 48; ++i)
                grey.at(i, j, k) = static_cast<float>(5.0 - glm::length(grey.position(i, j, k)) / mm);
    const volume::Grid distance = volume::distance_to_iso(grey, 0.0f);
    double worst = 0.0;
    for (int k = 0; k < 48; ++k)
        for (int j = 0; j < 48; ++j)
            for (int i = 0; i < 48; ++i)
                worst = std::max(worst,
                                 std::abs(distance.at(i, j, k) - (glm::length(distance.position(i, j, k)) - 5.0 * mm)));
    CAPTURE(worst / mm);
    CHECK(worst < 0.05 * mm);
}

TEST_CASE("the iso-surface is closed, oriented outwards and of the sphere's volume") {
    volume::Grid grey = cube_grid(40, 0.5 * mm);
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 40; ++i)
                grey.at(i, j, k) = static_cast<float>(7.0 * mm - glm::length(grey.position(i, j, k)));
    for (const bool above : {true, false}) {
        const geometry::TriangleSurface surface = geometry::iso_surface(grey, 0.0f, above);
        std::map<std::pair<int, int>, int> edges;
        double volume = 0.0;
        for (const auto& t : surface.triangles) {
            for (int c = 0; c < 3; ++c) ++edges[{t[std::size_t(c)], t[std::size_t((c + 1) % 3)]}];
            volume += glm::dot(surface.vertices[std::size_t(t[0])],
                               glm::cross(surface.vertices[std::size_t(t[1])], surface.vertices[std::size_t(t[2])])) /
                      6.0;
        }
        bool closed = true;
        for (const auto& [edge, count] : edges) closed = closed && count == 1 && edges.count({edge.second, edge.first});
        CHECK(closed);
        const double sphere = 4.0 / 3.0 * std::numbers::pi * std::pow(7.0 * mm, 3);
        CHECK(volume == Approx(above ? sphere : -sphere).epsilon(0.01));
    }
}

TEST_CASE("a box of triangles through the samples has an exact signed distance") {
    geometry::TriangleSurface box;
    for (int c = 0; c < 8; ++c)
        box.vertices.push_back(Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1) * (4.0 * mm));
    box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const volume::Grid layout = cube_grid(25, 0.5 * mm);
    const volume::Grid distance = volume::signed_distance(layout, box);
    double worst = 0.0;
    for (int k = 0; k < 25; ++k)
        for (int j = 0; j < 25; ++j)
            for (int i = 0; i < 25; ++i) {
                const Vec3 q = glm::abs(layout.position(i, j, k)) - Vec3(4.0 * mm);
                const double exact = glm::length(glm::max(q, Vec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
                worst = std::max(worst, std::abs(distance.at(i, j, k) - exact));
            }
    CHECK(worst < 1e-8);
}

TEST_CASE("removing a small part leaves the distance to the large one as if it had been alone") {
    volume::Grid both = cube_grid(40, 0.5 * mm);
    volume::Grid alone = both;
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 40; ++i) {
                const Vec3 at = both.position(i, j, k);
                const double large = 5.0 * mm - glm::length(at + Vec3(2.0 * mm, 0.0, 0.0));
                const double small = 2.0 * mm - glm::length(at - Vec3(6.5 * mm, 0.0, 0.0));
                alone.at(i, j, k) = static_cast<float>(large);
                both.at(i, j, k) = static_cast<float>(std::max(large, small));
            }
    const volume::Components parts = volume::components_above(both, 0.0f);
    REQUIRE(parts.voxels.size() == 2);
    CHECK(parts.voxels[0] > parts.voxels[1]);
    volume::keep_largest(both, 0.0f, parts, 1);
    const volume::Grid kept = volume::distance_to_iso(both, 0.0f), wanted = volume::distance_to_iso(alone, 0.0f);
    double worst = 0.0;
    for (std::size_t n = 0; n < kept.count(); ++n)
        worst = std::max(worst, std::abs(double(kept.values[n]) - double(wanted.values[n])));
    CHECK(worst < 0.01 * mm);
}

TEST_CASE("a closed hollow is filled and an open one is not") {
    volume::Grid shell = cube_grid(30, 0.5 * mm);
    for (int k = 0; k < 30; ++k)
        for (int j = 0; j < 30; ++j)
            for (int i = 0; i < 30; ++i)
                shell.at(i, j, k) =
                    static_cast<float>(1.5 * mm - std::abs(glm::length(shell.position(i, j, k)) - 4.5 * mm));
    volume::Grid open = shell;
    CHECK(volume::fill_hollows(shell, 0.0f) > 100);
    CHECK(shell.at(15, 15, 15) > 0.0f);
    for (int i = 15; i < 30; ++i) open.at(i, 15, 15) = -1.0f;
    CHECK(volume::fill_hollows(open, 0.0f) == 0);
}

TEST_CASE("resampling keeps a linear ramp and passes through the samples") {
    volume::Grid grid{{12, 9, 7}, {0.0, 1.0, 2.0}, {1.0, 0.5, 2.0}, {}};
    for (int k = 0; k < 7; ++k)
        for (int j = 0; j < 9; ++j)
            for (int i = 0; i < 12; ++i) grid.values.push_back(static_cast<float>(2 * i - 3 * j + k));
    CHECK(volume::resampled(grid, grid).values == grid.values);
    const volume::Grid inner = volume::resampled(grid, volume::Grid{{6, 5, 4}, {3.3, 2.1, 5.0}, {0.4, 0.2, 0.7}, {}});
    double worst = 0.0;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 6; ++i) {
                const Vec3 u = (inner.position(i, j, k) - grid.origin) / grid.spacing;
                worst = std::max(worst, std::abs(inner.at(i, j, k) - (2.0 * u.x - 3.0 * u.y + u.z)));
            }
    CHECK(worst < 1e-4);
}

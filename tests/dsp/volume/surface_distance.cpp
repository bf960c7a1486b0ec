// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/surface_distance.hpp"

#include "dsp/geometry/closest_point.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

using namespace tactus;

namespace {

// A lumpy body whose triangles have about the size of `cell`.
geometry::TriangleSurface lumps(double cell) {
    const int n = static_cast<int>(24e-3 / cell);
    volume::Grid grid{{n, n, n}, Vec3(1.0) - 0.5 * (n - 1) * Vec3(cell), Vec3(cell), {}};
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const Vec3 p = (grid.position(i, j, k) - Vec3(1.0)) * 1e3;
                const double waves = std::sin(1.1 * p.x) + std::sin(0.9 * p.y + 1.0) + std::sin(1.3 * p.z + 2.0);
                grid.values.push_back(static_cast<float>(glm::length(p) - 8.0 - 0.7 * waves));
            }
    return geometry::iso_surface(grid, 0.0f, false);
}

volume::Grid layout_of(const Vec3& h) {
    volume::Grid layout{{}, Vec3(1.0 - 14e-3), h, {}};
    for (int a = 0; a < 3; ++a) layout.size[static_cast<std::size_t>(a)] = static_cast<int>(28e-3 / h[a]);
    return layout;
}

double brute_force(const geometry::TriangleSurface& surface, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& t : surface.triangles) {
        const auto corner = [&](std::size_t c) { return surface.vertices[static_cast<std::size_t>(t[c])]; };
        const Vec3 d = geometry::closest_on_triangle(p, corner(0), corner(1), corner(2)) - p;
        least = std::min(least, glm::dot(d, d));
    }
    return std::sqrt(least);
}

}  // namespace

TEST_CASE("the distance to triangles is exact beside the surface and right within a tenth of a sample far from it",
          "[slow]") {
    for (const double triangle : {0.4e-3, 1e-3, 3e-3})
        for (const Vec3& h : {Vec3(0.7e-3), Vec3(0.5e-3, 0.5e-3, 0.9e-3)}) {
            const geometry::TriangleSurface surface = lumps(triangle);
            const volume::Grid layout = layout_of(h);
            const std::vector<float> distance = volume::surface_distance(layout, surface);
            const double widest = std::max({h.x, h.y, h.z});
            double near = 0.0, far = 0.0;
            std::vector<double> errors;
            for (std::size_t n = 0; n < distance.size(); n += 499) {
                const auto row = static_cast<std::size_t>(layout.size[0]), slab = layout.index(0, 0, 1);
                const Vec3 p = layout.position(static_cast<int>(n % row), static_cast<int>(n % slab / row),
                                               static_cast<int>(n / slab));
                const double exact = brute_force(surface, p), error = std::abs(double(distance[n]) - exact) / widest;
                if (exact < 1.49 * widest) near = std::max(near, error);
                else far = std::max(far, error), errors.push_back(error);
            }
            const auto p99 = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 99 / 100);
            std::nth_element(errors.begin(), p99, errors.end());
            CAPTURE(triangle, h.z, near, far, *p99);
            CHECK(near < 1e-5);
            CHECK(*p99 < 0.05);
            CHECK(far < 0.1);
        }
}

TEST_CASE("the distance to triangles has the same bits whoever runs its jobs", "[slow]") {
    const geometry::TriangleSurface surface = lumps(0.5e-3);
    const volume::Grid layout = layout_of(Vec3(0.6e-3));
    const volume::Grid alone = volume::signed_distance(layout, surface);
    const RunJobs backwards = [](int count, const std::function<void(int)>& job) {
        for (int n = count - 1; n >= 0; --n) job(n);
    };
    const RunJobs threads = [](int count, const std::function<void(int)>& job) {
        std::vector<std::thread> all;
        for (int t = 0; t < 3; ++t)
            all.emplace_back([&, t] {
                for (int n = t; n < count; n += 3) job(n);
            });
        for (std::thread& thread : all) thread.join();
    };
    CHECK(volume::signed_distance(layout, surface, backwards).values == alone.values);
    CHECK(volume::signed_distance(layout, surface, threads).values == alone.values);
}

TEST_CASE("a surface beside the grid, or none, makes samples outside of it and no fault") {
    volume::Grid layout = layout_of(Vec3(2e-3));
    for (const float d : volume::signed_distance(layout, geometry::TriangleSurface{}).values)
        CHECK(d == std::numeric_limits<float>::infinity());
    layout.origin = Vec3(3.0);
    for (const float d : volume::signed_distance(layout, lumps(2e-3)).values) CHECK(d > 0.0f);
    // Towards -x of the grid: rays along x have crossed it twice.
    layout.origin = Vec3(1.05, 1.0 - 14e-3, 1.0 - 14e-3);
    for (const float d : volume::signed_distance(layout, lumps(2e-3)).values) CHECK(d > 0.0f);
}

TEST_CASE("distances near a surface are those of the whole computation, and its reach with their sign beyond") {
    const geometry::TriangleSurface surface = lumps(1e-3);
    const volume::Grid layout = layout_of(Vec3(0.7e-3));
    const double reach = 2.1e-3;
    const volume::Grid whole = volume::signed_distance(layout, surface),
                       near = volume::signed_distance_near(layout, surface, reach);
    int beyond = 0;
    for (std::size_t n = 0; n < whole.values.size(); ++n) {
        const float there = whole.values[n];
        if (std::abs(there) < static_cast<float>(reach)) {
            // The whole computation takes over what its neighbours found; this one asks every triangle.
            REQUIRE(std::abs(near.values[n]) <= std::abs(there));
            REQUIRE(std::abs(near.values[n] - there) < 0.07e-3f);
            if (std::abs(there) < 1e-3f) REQUIRE(near.values[n] == there);
        } else {
            ++beyond;
            REQUIRE(near.values[n] == Approx(std::copysign(reach, static_cast<double>(there))).margin(0.07e-3));
        }
    }
    CHECK(beyond > 1000);
}

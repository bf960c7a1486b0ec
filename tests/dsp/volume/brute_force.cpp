// SPDX-License-Identifier: Apache-2.0
// The distance to the surface of grey values, beside the distance to every triangle of the same surface drawn finer.
#include "dsp/core/random.hpp"
#include "dsp/geometry/closest_point.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/volume/iso_distance.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>

using namespace tactus;

namespace {

// Lumps with ridges, necks and hollows a few samples across.
volume::Grid lumps(const Vec3& spacing, std::uint64_t seed) {
    volume::Grid grid{{36, 34, 32}, Vec3(0.9, -0.4, 1.1), spacing, {}};
    const Random random{seed};
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                double sum = -400.0;
                for (std::uint64_t n = 0; n < 40; ++n) {
                    const Vec3 centre(6.0 + 24.0 * random.uniform(5 * n), 6.0 + 22.0 * random.uniform(5 * n + 1),
                                      6.0 + 20.0 * random.uniform(5 * n + 2));
                    const double width = 1.8 + 2.2 * random.uniform(5 * n + 3);
                    const double height = random.uniform(5 * n + 4) < 0.7 ? 900.0 : -900.0;
                    const Vec3 d = (Vec3(i, j, k) - centre) / width;
                    sum += height * std::exp(-0.5 * glm::dot(d, d));
                }
                grid.values.push_back(static_cast<float>(sum));
            }
    return grid;
}

// Exact, over all triangles; those whose circle lies too far away are passed over.
struct Triangles {
    const geometry::TriangleSurface& surface;
    std::vector<Vec3> middle;
    double radius = 0.0;

    explicit Triangles(const geometry::TriangleSurface& all) : surface(all) {
        for (const auto& t : all.triangles) {
            middle.push_back((corner(t[0]) + corner(t[1]) + corner(t[2])) / 3.0);
            for (const int c : t) radius = std::max(radius, glm::length(corner(c) - middle.back()));
        }
    }
    const Vec3& corner(int n) const { return surface.vertices[std::size_t(n)]; }
    double to_nearest(const Vec3& at) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t n = 0; n < middle.size(); ++n) {
            const Vec3 difference = middle[n] - at;
            if (glm::dot(difference, difference) > (least + radius) * (least + radius)) continue;
            const auto& t = surface.triangles[n];
            least = std::min(
                least, glm::length(geometry::closest_on_triangle(at, corner(t[0]), corner(t[1]), corner(t[2])) - at));
        }
        return least;
    }
};

// Value of the Catmull–Rom cubic through four samples, `t` of the way from the second to the third.
double catmull_rom(const std::array<double, 4>& v, double t) {
    return v[1] + 0.5 * t *
                      (v[2] - v[0] +
                       t * (2.0 * v[0] - 5.0 * v[1] + 4.0 * v[2] - v[3] + t * (3.0 * (v[1] - v[2]) + v[3] - v[0])));
}

// `times` as fine along one axis, border repeated. Unlike volume::resampled it keeps what the cubic has beyond the
// samples, as the peaks of small lumps.
volume::Grid finer(const volume::Grid& grid, int axis, int times) {
    volume::Grid fine{grid.size, grid.origin, grid.spacing, {}};
    const auto a = static_cast<std::size_t>(axis);
    fine.size[a] = (grid.size[a] - 1) * times + 1;
    fine.spacing[axis] /= times;
    fine.values.reserve(fine.count());
    for (int k = 0; k < fine.size[2]; ++k)
        for (int j = 0; j < fine.size[1]; ++j)
            for (int i = 0; i < fine.size[0]; ++i) {
                std::array<int, 3> at{i, j, k};
                const int cell = at[a] / times, part = at[a] % times;
                std::array<double, 4> samples{};
                for (int n = 0; n < 4; ++n) {
                    at[a] = std::clamp(cell - 1 + n, 0, grid.size[a] - 1);
                    samples[static_cast<std::size_t>(n)] = grid.at(at[0], at[1], at[2]);
                }
                fine.values.push_back(static_cast<float>(catmull_rom(samples, double(part) / times)));
            }
    return fine;
}

geometry::TriangleSurface fine_surface(const volume::Grid& grey, int times) {
    return geometry::iso_surface(finer(finer(finer(grey, 0, times), 1, times), 2, times), 0.0f, true);
}

}  // namespace

TEST_CASE("the distance to lumps a few samples wide is that of brute force, isotropic or not, 1 m from the origin",
          "[slow]") {
    for (const Vec3 spacing : {Vec3(4e-4), Vec3(3.5e-4, 3.5e-4, 6e-4)}) {
        const volume::Grid grey = lumps(spacing, spacing.z > 5e-4 ? 3 : 2);
        const volume::Grid distance = volume::distance_to_iso(grey, 0.0f);
        const geometry::TriangleSurface surface = fine_surface(grey, 5);
        REQUIRE(surface.triangles.size() > 10000);
        const Triangles triangles(surface);
        const double voxel = spacing.x, band = 3.0 * spacing.z;
        std::vector<double> near, far;
        for (std::size_t n = 0; n < grey.count(); n += 53) {
            const int i = int(n % 36), j = int(n / 36 % 34), k = int(n / 36 / 34);
            const double exact = triangles.to_nearest(grey.position(i, j, k));
            const double error = std::abs(std::abs(double(distance.values[n])) - exact) / voxel;
            CHECK((distance.values[n] < 0.0f) == (grey.values[n] >= 0.0f));
            (exact < 0.9 * band ? near : far).push_back(error);
        }
        std::sort(near.begin(), near.end());
        std::sort(far.begin(), far.end());
        CAPTURE(spacing.z, near.size(), near[near.size() / 2], near[near.size() * 99 / 100], near.back(), far.size(),
                far[far.size() / 2], far[far.size() * 99 / 100], far.back());
        CHECK(near[near.size() * 99 / 100] < 0.015);
        CHECK(near.back() < 0.05);
        // Beyond three voxels the surface counts as flat across a cell.
        CHECK(far[far.size() / 2] < 0.05);
        CHECK(far.back() < 0.5);
    }
}

TEST_CASE(
    "within three voxels the distance to a ball, a ring and a slanted wall is exact to 0.02 voxel, 1 m from the "
    "origin") {
    const Vec3 h(3.5e-4, 3.5e-4, 6e-4), middle(1.0, -1.0, 1.2);
    volume::Grid grey{{80, 80, 50}, middle - 0.5 * Vec3(79, 79, 49) * h, h, {}};
    const Vec3 slant = glm::normalize(Vec3(1.0, 0.7, 0.4));
    const auto ball = [](const Vec3& p) { return glm::length(p) - 7e-3; };
    const auto ring = [](const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - 8e-3, p.z) - 3e-3; };
    const auto wall = [&](const Vec3& p) { return std::abs(glm::dot(p, slant)) - 1.2e-3; };
    const auto worst = [&](const auto& shape) {
        grey.values.clear();
        for (int k = 0; k < grey.size[2]; ++k)
            for (int j = 0; j < grey.size[1]; ++j)
                for (int i = 0; i < grey.size[0]; ++i)
                    // Steep, and saturated like bone and air of a CT.
                    grey.values.push_back(
                        static_cast<float>(std::clamp(-1e6 * shape(grey.position(i, j, k) - middle), -1300.0, 1300.0)));
        const volume::Grid distance = volume::distance_to_iso(grey, 0.0f);
        double error = 0.0;
        for (int k = 8; k + 8 < grey.size[2]; ++k)
            for (int j = 8; j + 8 < grey.size[1]; ++j)
                for (int i = 8; i + 8 < grey.size[0]; ++i) {
                    const double exact = shape(grey.position(i, j, k) - middle);
                    if (std::abs(exact) < 3.0 * h.x)
                        error = std::max(error, std::abs(double(distance.at(i, j, k)) - exact) / h.x);
                }
        return error;
    };
    CHECK(worst(ball) < 0.02);
    CHECK(worst(ring) < 0.02);
    CHECK(worst(wall) < 0.02);
}

TEST_CASE("the distance has the same bits whoever runs its jobs") {
    const volume::Grid grey = lumps(Vec3(4e-4), 5);
    const volume::Grid alone = volume::distance_to_iso(volume::smoothed(grey), 0.0f);
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
    CHECK(volume::distance_to_iso(volume::smoothed(grey, backwards), 0.0f, backwards).values == alone.values);
    CHECK(volume::distance_to_iso(volume::smoothed(grey, threads), 0.0f, threads).values == alone.values);
}

TEST_CASE("worked on a few layers at a time, the distance has the bits of the whole up to its reach", "[slow]") {
    // Lumps of all sizes, and deep inside a block, where the nearest surface is farther than the reach.
    for (const Vec3 spacing : {Vec3(4e-4), Vec3(3.5e-4, 3.5e-4, 6e-4)}) {
        volume::Grid grey = lumps(spacing, 5);
        const int rows = grey.size[1], layers = 3 * grey.size[2];
        grey.size[2] = layers;
        const std::vector<float> once = grey.values;
        for (int n = 0; n < 2; ++n) grey.values.insert(grey.values.end(), once.begin(), once.end());
        for (int k = 20; k < layers - 12; ++k)
            for (int j = 2; j < rows - 2; ++j)
                for (int i = 20; i < grey.size[0] - 1; ++i)
                    grey.at(i, j, k) = std::max(grey.at(i, j, k), 1e-3f * float(std::min(i - 20, 10)));
        const volume::Grid whole = volume::distance_to_iso(grey, 0.0f);
        for (const double reach : {8.0 * spacing.z, 1.0})
            for (const int at_once : {1, 8, 24, 1000}) {
                CAPTURE(spacing.z, reach, at_once);
                std::size_t other = 0, next = 0;
                volume::distance_to_iso(
                    volume::Grid{grey.size, grey.origin, grey.spacing, {}}, 0.0f, {reach, at_once},
                    [&](int first, int count) {
                        volume::Grid part{{grey.size[0], rows, count}, grey.position(0, 0, first), grey.spacing, {}};
                        const auto layer = static_cast<std::ptrdiff_t>(grey.index(0, 0, 1));
                        part.values.assign(grey.values.begin() + first * layer,
                                           grey.values.begin() + (first + count) * layer);
                        return part;
                    },
                    [&](int first, const volume::Grid& part) {
                        CHECK(grey.index(0, 0, first) == next);
                        for (const float d : part.values)
                            other += d != std::min(whole.values[next++], static_cast<float>(reach));
                    });
                CHECK(next == whole.count());
                CHECK(other == 0);
            }
    }
}

TEST_CASE("volumes that are all bone, all air or one sample thick have a distance and no fault") {
    for (const std::array<int, 3> size : {std::array<int, 3>{5, 4, 3}, {1, 1, 1}, {7, 1, 1}, {6, 5, 1}}) {
        volume::Grid grid{size, Vec3(0.0), Vec3(1e-3), {}};
        grid.values.assign(grid.count(), 1.0f);
        for (const float d : volume::distance_to_iso(grid, 0.0f).values)
            CHECK(d == -std::numeric_limits<float>::infinity());
        grid.values.assign(grid.count(), -1.0f);
        for (const float d : volume::distance_to_iso(grid, 0.0f).values)
            CHECK(d == std::numeric_limits<float>::infinity());
    }
    volume::Grid thin{{2, 2, 2}, Vec3(0.0), Vec3(1e-3), {-1, 1, -1, 1, -1, 1, -1, 1}};
    for (int n = 0; n < 8; ++n)
        CHECK(volume::distance_to_iso(thin, 0.0f).values[std::size_t(n)] == Approx(n % 2 ? -5e-4 : 5e-4));
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/distance/iso_distance.hpp"

#include "dsp/distance/closest_point.hpp"
#include "dsp/distance/surface_distance.hpp"

#include <algorithm>
#include <cmath>

namespace tactus {

namespace {

struct Spline {
    std::array<double, 4> weight, slope;
};

// Catmull and Rom's cubic: weights of four neighbours at t in [0, 1] between the middle two, and their derivatives.
Spline catmull_rom(double t) {
    const double t2 = t * t, t3 = t2 * t;
    return {{-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2},
            {-1.5 * t2 + 2.0 * t - 0.5, 4.5 * t2 - 5.0 * t, -4.5 * t2 + 4.0 * t + 0.5, 1.5 * t2 - t}};
}

struct Interpolant {
    const Grid& grid;

    struct Sample {
        double value;
        Vec3 gradient;  // per m
    };

    Sample operator()(const Vec3& at) const {
        std::array<Spline, 3> spline{};
        std::array<std::array<int, 4>, 3> index{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const int last = grid.size[a] - 1;
            const double u = std::clamp((at[axis] - grid.origin[axis]) / grid.spacing[axis], 0.0, double(last));
            const int cell = std::min(static_cast<int>(u), std::max(last - 1, 0));
            spline[a] = catmull_rom(u - cell);
            for (int n = 0; n < 4; ++n) index[a][static_cast<std::size_t>(n)] = std::clamp(cell - 1 + n, 0, last);
        }
        double value = 0.0, gx = 0.0, gy = 0.0, gz = 0.0;
        for (std::size_t c = 0; c < 4; ++c)
            for (std::size_t b = 0; b < 4; ++b) {
                const float* row = &grid.values[grid.index(0, index[1][b], index[2][c])];
                double along = 0.0, slope = 0.0;
                for (std::size_t a = 0; a < 4; ++a) {
                    const double sample = row[index[0][a]];
                    along += spline[0].weight[a] * sample;
                    slope += spline[0].slope[a] * sample;
                }
                value += spline[2].weight[c] * spline[1].weight[b] * along;
                gx += spline[2].weight[c] * spline[1].weight[b] * slope;
                gy += spline[2].weight[c] * spline[1].slope[b] * along;
                gz += spline[2].slope[c] * spline[1].weight[b] * along;
            }
        return {value, Vec3(gx, gy, gz) / grid.spacing};
    }
};

// A step along the gradient onto the surface, at most half a cell long so that a flat spot throws nothing away.
Vec3 onto_surface(const Interpolant::Sample& f, double iso, double reach) {
    const double steep = glm::dot(f.gradient, f.gradient);
    if (!(steep > 0.0)) return Vec3(0.0);
    const Vec3 step = f.gradient * ((iso - f.value) / steep);
    const double length = glm::length(step);
    return length > reach ? step * (reach / length) : step;
}

// Corners of tetrahedra cut along diagonals lie beside the surface; two steps bring them onto it.
void settle(TriangleSurface& surface, const Interpolant& f, double iso, double reach) {
    for (Vec3& vertex : surface.vertices)
        for (int step = 0; step < 2; ++step) vertex += onto_surface(f(vertex), iso, reach);
}

// The point of the surface nearest to `at`, from a near guess: steps onto the surface, and along it towards `at`.
// Returns the distance, or `start` when the steps do not settle.
double refine(const Vec3& at, const Vec3& guess, const Interpolant& f, double iso, double cell, double start) {
    Vec3 x = guess;
    for (int step = 0; step < 4; ++step) {
        const auto here = f(x);
        const double steep = glm::dot(here.gradient, here.gradient);
        if (!(steep > 0.0)) return start;
        const Vec3 towards = at - x;
        Vec3 along = towards - here.gradient * (glm::dot(towards, here.gradient) / steep);
        const double length = glm::length(along);
        if (length > 0.25 * cell) along *= 0.25 * cell / length;
        const Vec3 move = onto_surface(here, iso, 0.5 * cell) + along;
        x += move;
        if (glm::length(move) < 1e-4 * cell) break;
    }
    const auto here = f(x);
    const double steep = glm::length(here.gradient);
    const double off = steep > 0.0 ? std::abs(here.value - iso) / steep : cell;
    const double distance = glm::length(at - x);
    // Settled: on the surface, and straight below `at`.
    const bool foot = distance < 1e-3 * cell || std::abs(glm::dot(at - x, here.gradient)) > 0.995 * distance * steep;
    return off < 0.01 * cell && foot && std::abs(distance - start) < 0.25 * cell ? distance : start;
}

void smooth_axis(const Grid& in, Grid& out, int axis) {
    const auto& size = in.size;
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i) {
                std::array<int, 3> low{i, j, k}, high{i, j, k};
                const auto a = static_cast<std::size_t>(axis);
                low[a] = std::max(low[a] - 1, 0);
                high[a] = std::min(high[a] + 1, size[a] - 1);
                out.at(i, j, k) =
                    (in.at(low[0], low[1], low[2]) + 4.0f * in.at(i, j, k) + in.at(high[0], high[1], high[2])) / 6.0f;
            }
}

}  // namespace

Grid smoothed(const Grid& grid) {
    Grid a = grid, b = grid;
    smooth_axis(grid, a, 0);
    smooth_axis(a, b, 1);
    smooth_axis(b, a, 2);
    return a;
}

Grid distance_to_iso(const Grid& grey, float iso) {
    const double cell = std::min({grey.spacing.x, grey.spacing.y, grey.spacing.z});
    const double band = 3.0 * std::max({grey.spacing.x, grey.spacing.y, grey.spacing.z});
    const Interpolant f{grey};
    TriangleSurface surface = iso_surface(grey, iso, true);
    settle(surface, f, iso, 0.5 * cell);
    NearestTriangles nearest = nearest_triangles(grey, surface);
    Grid out{grey.size, grey.origin, grey.spacing, std::move(nearest.distance)};
    for (int k = 0; k < grey.size[2]; ++k)
        for (int j = 0; j < grey.size[1]; ++j)
            for (int i = 0; i < grey.size[0]; ++i) {
                float& value = out.at(i, j, k);
                const std::int32_t id = nearest.triangle[grey.index(i, j, k)];
                if (id >= 0 && value < band) {
                    const auto& t = surface.triangles[static_cast<std::size_t>(id)];
                    const Vec3 at = grey.position(i, j, k);
                    const Vec3 foot = closest_on_triangle(at, surface.vertices[static_cast<std::size_t>(t[0])],
                                                          surface.vertices[static_cast<std::size_t>(t[1])],
                                                          surface.vertices[static_cast<std::size_t>(t[2])]);
                    value = static_cast<float>(refine(at, foot, f, iso, cell, value));
                }
                if (grey.at(i, j, k) >= iso) value = -value;
            }
    return out;
}

}  // namespace tactus

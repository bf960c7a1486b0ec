// SPDX-License-Identifier: Apache-2.0
// Points on the surface where grey values cross a level, and the distance to it. For iso_distance.cpp.
#pragma once

#include "dsp/volume/cubic_interpolant.hpp"
#include "dsp/volume/grid.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace tactus::volume {

/// Points on the surface, about one per cell that it crosses, with normals.
struct SurfacePoints {
    std::vector<glm::vec3> at;      // samples from the origin
    std::vector<glm::vec3> normal;  // unit length in m, towards lower values
};

/// A Newton step along the gradient onto the surface, m, at most `reach` long to bound it where the gradient is small.
inline Vec3 onto_surface(const CubicInterpolant::Sample& f, double iso, double reach) {
    const double steep = glm::dot(f.gradient, f.gradient);
    if (!(steep > 0.0)) return Vec3(0.0);
    const Vec3 step = f.gradient * ((iso - f.value) / steep);
    const double length = glm::length(step);
    return length > reach ? step * (reach / length) : step;
}

// `grey` holds layers of the volume from `first` on; all positions count from the volume's first layer.
struct SurfaceFinder {
    const Grid& grey;
    int first, layers;  // held from here on; number of layers in the whole volume
    float iso;
    CubicInterpolant f{grey, first, layers};
    double cell = std::min({grey.spacing.x, grey.spacing.y, grey.spacing.z});
    double widest = std::max({grey.spacing.x, grey.spacing.y, grey.spacing.z});
    glm::vec3 h{grey.spacing};

    // The mean of the cell's edge crossings, moved onto the surface.
    std::optional<Vec3> point_in_cell(int i, int j, int k, const std::array<float, 8>& value) const {
        Vec3 sum(0.0);
        int count = 0;
        for (int from = 0; from < 8; ++from)
            for (int bit = 1; bit < 8; bit <<= 1) {
                if (from & bit) continue;
                const float a = value[static_cast<std::size_t>(from)], b = value[static_cast<std::size_t>(from | bit)];
                if ((a >= iso) == (b >= iso)) continue;
                const double t = (double(iso) - double(a)) / (double(b) - double(a));
                Vec3 at(from & 1, from >> 1 & 1, from >> 2);
                at[bit >> 1] += t;
                sum += at;
                ++count;
            }
        if (count == 0) return {};
        const Vec3 corner(i, j, k);
        Vec3 at = corner + sum / double(count);
        for (int step = 0; step < 2; ++step) at += onto_surface(f(at), iso, 0.5 * cell) / grey.spacing;
        return glm::clamp(at, corner, corner + 1.0);
    }

    void points_of_layer(int k, SurfacePoints& points) const {
        const auto width = static_cast<std::size_t>(grey.size[0]), layer = grey.index(0, 0, 1);
        for (int j = 0; j + 1 < grey.size[1]; ++j) {
            const float* row = &grey.values[grey.index(0, j, k - first)];
            for (int i = 0; i + 1 < grey.size[0]; ++i, ++row) {
                const std::array<float, 8> value{
                    row[0],     row[1],         row[width],         row[width + 1],
                    row[layer], row[layer + 1], row[layer + width], row[layer + width + 1]};
                int above = 0;
                for (const float v : value) above += v >= iso;
                if (above == 0 || above == 8) continue;
                const auto at = point_in_cell(i, j, k, value);
                const Vec3 slope = f(*at).gradient;
                const double length = glm::length(slope);
                points.at.push_back(glm::vec3(*at));
                points.normal.push_back(glm::vec3(length > 0.0 ? -slope / length : Vec3(0.0)));
            }
        }
    }

    // Distance to the surface point nearest to `at`, from an initial guess: steps onto the surface, and along it
    // towards `at`, as long as the estimated curvature requires. Infinite when no surface point was found.
    double refined(const Vec3& at, const Vec3& guess) const {
        Vec3 x = guess, moved(0.0), before(0.0);
        double best = std::numeric_limits<double>::infinity(), stretch = 1.0;
        for (int step = 0; step < 10; ++step) {
            const auto here = f(x);
            const double steep = glm::dot(here.gradient, here.gradient);
            if (!(steep > 0.0)) break;
            const Vec3 towards = (at - x) * grey.spacing;
            const Vec3 along = towards - here.gradient * (glm::dot(towards, here.gradient) / steep);
            const double off = std::abs(here.value - double(iso)) / std::sqrt(steep), aside = glm::length(along);
            const double far = glm::length(towards);
            if (off < 2e-3 * cell) {
                best = std::min(best, far);
                // Directly below `at`, a sideways error changes the distance in second order only.
                if (aside < 0.04 * far || aside < 2e-3 * cell) break;
            }
            // On a convex surface a full step overshoots, on a concave one it falls short.
            if (const double length2 = glm::dot(moved, moved); length2 > 0.0)
                stretch = std::clamp(length2 / std::max(glm::dot(before - along, moved), 1e-9 * length2), 0.2, 2.0);
            moved = along * std::min(stretch, 0.6 * cell / std::max(aside, 1e-30));
            before = along;
            x += (onto_surface(here, iso, 0.5 * cell) + moved) / grey.spacing;
        }
        return best;
    }
};

}  // namespace tactus::volume

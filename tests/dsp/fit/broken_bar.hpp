// SPDX-License-Identifier: Apache-2.0
// Two halves of a bar that was broken along a relief, and starts beside the truth.
#pragma once

#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/fit.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace tactus::test {

/// Height of the break over (y, z), m.
using Relief = std::function<double(double, double)>;

/// Waves of 4 to 9 mm, about half a millimetre high.
inline Relief rough_relief(std::uint64_t seed, double height = 0.6 * mm) {
    const Random random{seed};
    std::vector<std::array<double, 4>> waves;
    for (std::uint64_t n = 0; n < 8; ++n) {
        const double k = 2.0 * 3.14159265 / ((4.0 + 5.0 * random.uniform(4 * n)) * mm);
        const double way = 6.2831853 * random.uniform(4 * n + 1);
        waves.push_back({k * std::cos(way), k * std::sin(way), 6.2831853 * random.uniform(4 * n + 2), height * 0.5});
    }
    return [waves](double y, double z) {
        double h = 0.0;
        for (const auto& w : waves) h += w[3] * std::sin(w[0] * y + w[1] * z + w[2]);
        return h;
    };
}

struct BarOptions {
    Vec3 voxel{0.5 * mm};
    double spacing = 0.6 * mm;
    double over = 0.0;       ///< m of the outside next to the break that is painted too
    double half = 1.0;       ///< share of the break, from z = −12 mm up, that is painted
    double gap = 0.0;        ///< m of bone lost
    double chipped = 0.0;    ///< share of the break, in stripes across, chipped off the left half to 1.6 mm
    Vec3 far{0.0};           ///< where the file has the half
    bool is_flat = false;    ///< the section is a rectangle, not an ellipse
    double bend = 1.0;       ///< ratio of the section's lower half width to the upper one
    double swell = 0.0;      ///< m: the bar's sides wave by it along x, over y
    double wave = 30.0 * mm, phase = 0.0;  ///< m, and rad at the break
};

struct Half {
    std::vector<contact::SurfacePoint> points;
    volume::Grid distance;

    fit::FitSurface surface() const { return fit::make_fit_surface(points, distance); }
};

/// A bar of elliptic section, 12 by 24 mm, 18 mm of it to the left (side −1) or right (+1) of the break.
inline Half bar_half(double side, const Relief& relief, const BarOptions& o = {}) {
    const auto bar = [&o](Vec3 p) {
        p.y -= o.swell * std::sin(2.0 * 3.14159265 * p.x / o.wave + o.phase);
        if (o.is_flat)
            return std::max({std::abs(p.y) - 6.0 * mm, std::abs(p.z) - 12.0 * mm, std::abs(p.x) - 18.0 * mm});
        const double width = 6.0 * mm * (p.z < 0.0 ? o.bend : 1.0);
        const double r = std::hypot(p.y / width, p.z / (12.0 * mm));
        const double steep = std::hypot(p.y / (width * width), p.z / (144.0 * mm * mm)) / std::max(r, 1e-9);
        return std::max(r < 1e-6 ? -width : (r - 1.0) / std::max(steep, 1e-9), std::abs(p.x) - 18.0 * mm);
    };
    const auto chip = [&](const Vec3& p) {
        const double stripe = std::fmod(p.z + 24.0 * mm, 6.0 * mm) / (6.0 * mm);
        return side < 0.0 && stripe < o.chipped ? 1.6 * mm * (1.0 - stripe / o.chipped) : 0.0;
    };
    Half made;
    volume::Grid& grid = made.distance;
    const Vec3 low = Vec3(side < 0.0 ? -22.0 * mm : -6.0 * mm, -10.0 * mm, -16.0 * mm);
    const Vec3 high = Vec3(side < 0.0 ? 6.0 * mm : 22.0 * mm, 10.0 * mm, 16.0 * mm);
    grid.spacing = o.voxel;
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low[axis]) / o.voxel[axis]) + 1;
    grid.origin = low;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 p = grid.position(i, j, k);
                const double cut = -side * (p.x - relief(p.y, p.z)) + 0.5 * o.gap + chip(p);
                grid.values.push_back(static_cast<float>(std::max(bar(p), cut / 1.15)));
            }
    made.points = contact::sample_surface(grid, {.spacing = o.spacing});
    for (contact::SurfacePoint& p : made.points) {
        const bool broken = bar(p.position) < -0.4 * mm && std::abs(p.position.x) < 6.0 * mm;
        const bool spilled = std::abs(p.position.x - relief(p.position.y, p.position.z)) < o.over;
        if ((broken || spilled) && p.position.z < (-12.0 + 24.0 * o.half) * mm)
            p.label = contact::surface_label::fracture;
        p.position += o.far;
    }
    grid.origin += o.far;
    return made;
}

/// The other hand's: mirrored in y.
inline Half mirrored(Half half) {
    volume::Grid turned = half.distance;
    for (int k = 0; k < turned.size[2]; ++k)
        for (int j = 0; j < turned.size[1]; ++j)
            for (int i = 0; i < turned.size[0]; ++i)
                turned.at(i, j, k) = half.distance.at(i, turned.size[1] - 1 - j, k);
    turned.origin.y = -(half.distance.origin.y + (turned.size[1] - 1) * turned.spacing.y);
    half.distance = turned;
    for (contact::SurfacePoint& p : half.points) p.position.y = -p.position.y, p.normal.y = -p.normal.y;
    return half;
}

inline Pose beside(double offset, double angle, std::uint64_t seed) {
    const Random random{seed};
    const auto way = [&](std::uint64_t n) {
        return glm::normalize(Vec3(random.normal(n), random.normal(n + 1), random.normal(n + 2)));
    };
    return {offset * way(0), rotation_by(angle * way(3))};
}

/// Root mean square over the half's points of how far a pose is from `truth`, m.
inline double error_of(const Half& half, const Pose& pose, const Pose& truth = {}) {
    double sum = 0.0;
    for (const contact::SurfacePoint& p : half.points) {
        const Vec3 off = pose.apply(p.position) - truth.apply(p.position);
        sum += glm::dot(off, off);
    }
    return std::sqrt(sum / static_cast<double>(half.points.size()));
}

}  // namespace tactus::test

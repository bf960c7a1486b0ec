// SPDX-License-Identifier: Apache-2.0
// Gap and contact of two boxes against sums over fine squares on their faces, with exact distances.
#include "dsp/fit/mutual_gap.hpp"

#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace tactus;

namespace {

struct Box {
    Vec3 low, high;  // m

    double distance(const Vec3& p) const {
        const Vec3 q = glm::abs(p - 0.5 * (low + high)) - 0.5 * (high - low);
        return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
    }
    Vec3 slope(const Vec3& p) const {
        constexpr double h = 1e-6;
        Vec3 g;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step(0.0);
            step[axis] = h;
            g[axis] = (distance(p + step) - distance(p - step)) / (2.0 * h);
        }
        return g;
    }
    volume::Grid grid() const {
        constexpr double spacing = 0.25 * mm, around = 4.0 * mm;
        volume::Grid g;
        for (int axis = 0; axis < 3; ++axis)
            g.size[static_cast<std::size_t>(axis)] =
                static_cast<int>((high[axis] - low[axis] + 2.0 * around) / spacing) + 2;
        g.origin = low - Vec3(around);
        g.spacing = Vec3(spacing);
        for (int k = 0; k < g.size[2]; ++k)
            for (int j = 0; j < g.size[1]; ++j)
                for (int i = 0; i < g.size[0]; ++i)
                    g.values.push_back(static_cast<float>(distance(g.position(i, j, k))));
        return g;
    }
};

struct Bone {
    Box box;
    Pose pose;
    volume::Grid grid = box.grid();
    std::vector<contact::SurfacePoint> points = contact::sample_surface(grid, {});
    contact::Voxmap map = contact::make_voxmap(grid);

    Bone(const Box& b, const Pose& p) : box(b), pose(p) {}
    fit::PlacedBone placed() const { return {points, &map, pose, pose}; }
};

struct Sums {
    double facing = 0.0, contact = 0.0, deepest = 0.0;
    std::vector<std::pair<double, double>> distances;  // with areas
};

/// Squares of 0.1 mm on the faces of one box against the other.
void sum(const Bone& mine, const Bone& other, Sums& sums) {
    constexpr double step = 0.1 * mm;
    const Pose into = other.pose.inverse() * mine.pose;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool is_high : {false, true}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            Vec3 normal(0.0), p;
            normal[axis] = is_high ? 1.0 : -1.0;
            p[axis] = is_high ? mine.box.high[axis] : mine.box.low[axis];
            for (p[u] = mine.box.low[u] + 0.5 * step; p[u] < mine.box.high[u]; p[u] += step)
                for (p[v] = mine.box.low[v] + 0.5 * step; p[v] < mine.box.high[v]; p[v] += step) {
                    const Vec3 there = into.apply(p);
                    const double d = other.box.distance(there);
                    sums.deepest = std::max(sums.deepest, -d);
                    if (std::abs(d) >= 3.0 * mm || glm::dot(into.rotate(normal), other.box.slope(there)) >= -0.3)
                        continue;
                    sums.facing += 0.5 * step * step;
                    if (d < 0.3 * mm) sums.contact += 0.5 * step * step;
                    sums.distances.emplace_back(d, step * step);
                }
        }
}

double median_of(Sums& sums) {
    std::ranges::sort(sums.distances);
    return sums.distances[sums.distances.size() / 2].first;  // all squares have one area
}

}  // namespace

TEST_CASE("gap and contact of two bones are those of exact distances on both surfaces, in either order") {
    const double half = 0.5 * 1.5 * 3.14159265358979 / 180.0;
    const Pose poses[] = {{Vec3(-10.2, 0.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}},
                          {Vec3(-10.3, 0.4, -0.3) * mm, {std::cos(half), 0.0, 0.0, std::sin(half)}},
                          {Vec3(-9.6, 1.0, 0.0) * mm, {std::cos(half), 0.0, std::sin(half), 0.0}}};
    // The second is larger on all sides: its surface faces the first one's sides too.
    const Bone large({Vec3(0.0, -8.0, -8.0) * mm, Vec3(20.0, 20.0, 22.0) * mm}, {});
    for (const Pose& pose : poses) {
        const Bone small({Vec3(0.0) * mm, Vec3(10.0, 12.0, 14.0) * mm}, pose);
        const fit::MutualGap gap = fit::mutual_gap(small.placed(), large.placed()),
                             turned = fit::mutual_gap(large.placed(), small.placed());
        Sums exact;
        sum(small, large, exact);
        sum(large, small, exact);
        CAPTURE(gap.facing * 1e6, exact.facing * 1e6, gap.contact * 1e6, exact.contact * 1e6);
        CHECK(gap.facing == Approx(exact.facing).epsilon(0.03));
        CHECK(gap.contact == Approx(exact.contact).epsilon(0.04).margin(2e-6));
        CHECK(gap.median == Approx(median_of(exact)).margin(0.04 * mm));
        CHECK(gap.deepest == Approx(exact.deepest).margin(0.1 * mm));
        CHECK(turned.facing == Approx(gap.facing));
        CHECK(turned.contact == Approx(gap.contact).margin(1e-12));
        CHECK(turned.median == gap.median);
        CHECK(turned.deepest == gap.deepest);
    }
}

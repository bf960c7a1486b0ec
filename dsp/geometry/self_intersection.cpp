// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/self_intersection.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>

namespace tactus::geometry {

namespace {

using Corners = std::array<Vec3, 3>;

constexpr double touching = 1e-6;  // of the longest edge

Corners corners_of(const TriangleSurface& surface, std::size_t t) {
    Corners c;
    for (std::size_t n = 0; n < 3; ++n) c[n] = surface.vertices[static_cast<std::size_t>(surface.triangles[t][n])];
    return c;
}

/// Whether an axis separates them, or they overlap by less than `reach` along it.
bool separates(const Vec3& axis, const Corners& s, const Corners& t, double reach) {
    const double length = glm::length(axis);
    if (!(length > 0.0)) return false;
    const auto span = [&](const Corners& c) {
        const double x = glm::dot(axis, c[0]), y = glm::dot(axis, c[1]), z = glm::dot(axis, c[2]);
        return std::array{std::min({x, y, z}), std::max({x, y, z})};
    };
    const auto a = span(s), b = span(t);
    return a[1] <= b[0] + reach * length || b[1] <= a[0] + reach * length;
}

bool meet(const Vec3& low_a, const Vec3& high_a, const Vec3& low_b, const Vec3& high_b) {
    return low_a.x <= high_b.x && low_b.x <= high_a.x && low_a.y <= high_b.y && low_b.y <= high_a.y &&
           low_a.z <= high_b.z && low_b.z <= high_a.z;
}

}  // namespace

bool intersect(const TriangleSurface& surface, std::size_t a, std::size_t b) noexcept {
    const auto &s = surface.triangles[a], &t = surface.triangles[b];
    const Corners p = corners_of(surface, a), q = corners_of(surface, b);
    const Vec3 n = glm::cross(p[1] - p[0], p[2] - p[0]), m = glm::cross(q[1] - q[0], q[2] - q[0]);
    if (n == Vec3(0.0) || m == Vec3(0.0)) return false;
    std::array<std::size_t, 3> in_a{}, in_b{};
    std::size_t common = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (s[i] == t[j]) in_a[common] = i, in_b[common++] = j;
    if (common >= 3) return true;
    if (common == 2) {
        // They lie on each other when they are in one plane on one side of the common edge.
        const Vec3 at = p[in_a[0]], edge = p[in_a[1]] - at;
        const auto other = [&](const Corners& c, const auto& in) { return c[3 - in[0] - in[1]] - at; };
        const Vec3 u = glm::cross(edge, other(p, in_a)), v = glm::cross(edge, other(q, in_b));
        return glm::dot(u, v) > 0.0 && glm::length(glm::cross(u, v)) <= 1e-9 * glm::length(u) * glm::length(v);
    }
    // Corners relative to one of them, so that rounding is that of the triangles' size.
    Corners u, v;
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        u[i] = p[i] - p[0], v[i] = q[i] - p[0];
        longest = std::max({longest, glm::length(p[(i + 1) % 3] - p[i]), glm::length(q[(i + 1) % 3] - q[i])});
    }
    const double reach = touching * longest;
    if (separates(n, u, v, reach) || separates(m, u, v, reach)) return false;
    // Edges across both planes, for triangles of one plane; then edges across each other.
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 edge = u[(i + 1) % 3] - u[i], other = v[(i + 1) % 3] - v[i];
        if (separates(glm::cross(n, edge), u, v, reach) || separates(glm::cross(m, other), u, v, reach)) return false;
    }
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 edge = u[(i + 1) % 3] - u[i], other = v[(j + 1) % 3] - v[j], axis = glm::cross(edge, other);
            // Of parallel edges the direction is rounding.
            if (glm::length(axis) <= 1e-7 * glm::length(edge) * glm::length(other)) continue;
            if (separates(axis, u, v, reach)) return false;
        }
    return true;
}

TriangleBoxes::TriangleBoxes(const TriangleSurface& surface, double margin)
    : surface_(surface), order_(surface.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    for (std::size_t t = 0; t < order_.size(); ++t) {
        const Corners c = corners_of(surface, t);
        low_.push_back(glm::min(c[0], glm::min(c[1], c[2])) - margin);
        high_.push_back(glm::max(c[0], glm::max(c[1], c[2])) + margin);
    }
    if (!order_.empty()) build(order_, 0);
}

void TriangleBoxes::build(std::span<std::uint32_t> part, std::uint32_t first) {
    const std::size_t at = nodes_.size();
    Node node{Vec3(std::numeric_limits<double>::infinity()), Vec3(-std::numeric_limits<double>::infinity()), first, 0};
    for (const std::uint32_t t : part)
        node.low = glm::min(node.low, low_[t]), node.high = glm::max(node.high, high_[t]);
    nodes_.push_back(node);
    if (part.size() <= 6) {
        nodes_[at].count = static_cast<std::uint32_t>(part.size());
        return;
    }
    const Vec3 extent = node.high - node.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::size_t half = part.size() / 2;
    std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = low_[a][axis] + high_[a][axis], y = low_[b][axis] + high_[b][axis];
                         return x < y || (x == y && a < b);
                     });
    build(part.first(half), first);
    nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
    build(part.subspan(half), first + static_cast<std::uint32_t>(half));
}

void TriangleBoxes::intersections_of(std::size_t t, bool with_all, std::vector<std::array<int, 2>>& found) const {
    std::array<std::uint32_t, 80> stack;
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t at = stack[--depth];
        const Node& node = nodes_[at];
        if (!meet(low_[t], high_[t], node.low, node.high)) continue;
        for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
            const std::size_t other = order_[n];
            if (other == t || (other < t && !with_all) || !meet(low_[t], high_[t], low_[other], high_[other])) continue;
            if (intersect(surface_, t, other))
                found.push_back({static_cast<int>(std::min(t, other)), static_cast<int>(std::max(t, other))});
        }
        if (node.count > 0) continue;
        stack[depth++] = node.first;
        stack[depth++] = at + 1;
    }
}

std::vector<std::array<int, 2>> self_intersections(const TriangleSurface& surface, std::size_t most,
                                                   const RunJobs& run) {
    const TriangleBoxes boxes(surface);
    constexpr std::size_t chunk = 2048;
    const std::size_t count = surface.triangles.size(), jobs = (count + chunk - 1) / chunk;
    std::vector<std::vector<std::array<int, 2>>> found(jobs);
    run(static_cast<int>(jobs), [&](int job) {
        const auto j = static_cast<std::size_t>(job);
        for (std::size_t t = j * chunk; t < std::min(count, (j + 1) * chunk) && found[j].size() < most; ++t)
            boxes.intersections_of(t, false, found[j]);
    });
    std::vector<std::array<int, 2>> all;
    for (const auto& each : found) all.insert(all.end(), each.begin(), each.end());
    std::ranges::sort(all);
    if (all.size() > most) all.resize(most);
    return all;
}

}  // namespace tactus::geometry

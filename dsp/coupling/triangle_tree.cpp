// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/triangle_tree.hpp"

#include "dsp/distance/closest_point.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tactus {

namespace {

constexpr std::size_t leaf_triangles = 4;
// Halving 2^31 triangles down to leaves of four needs 30 levels.
constexpr std::size_t most_levels = 64;

double distance2(const Vec3& p, const Vec3& low, const Vec3& high) {
    const Vec3 d = p - glm::clamp(p, low, high);
    return glm::dot(d, d);
}

/// True when the segment a + t (b − a), 0 ≤ t ≤ most, meets the box.
bool meets(const Vec3& a, const Vec3& way, double most, const Vec3& low, const Vec3& high) {
    double from = 0.0, to = most;
    for (int axis = 0; axis < 3; ++axis) {
        if (way[axis] == 0.0) {
            if (a[axis] < low[axis] || a[axis] > high[axis]) return false;
            continue;
        }
        const double t0 = (low[axis] - a[axis]) / way[axis], t1 = (high[axis] - a[axis]) / way[axis];
        from = std::max(from, std::min(t0, t1));
        to = std::min(to, std::max(t0, t1));
    }
    return from <= to;
}

/// Möller and Trumbore 1997; the border belongs to the triangle, so that a segment slips through no edge.
double meets_at(const Vec3& a, const Vec3& way, const Vec3* t) {
    const Vec3 u = t[1] - t[0], v = t[2] - t[0], n = glm::cross(way, v);
    const double det = glm::dot(u, n);
    if (std::abs(det) < 1e-30) return 2.0;
    const Vec3 s = a - t[0], q = glm::cross(s, u);
    const double x = glm::dot(s, n) / det, y = glm::dot(way, q) / det, at = glm::dot(v, q) / det;
    constexpr double border = -1e-9;
    return x >= border && y >= border && x + y <= 1.0 - border && at >= 0.0 ? at : 2.0;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleSurface& surface) {
    std::vector<Vec3> corners;
    for (const auto& t : surface.triangles)
        for (const int v : t) corners.push_back(surface.vertices[static_cast<std::size_t>(v)]);
    if (corners.empty()) return;
    std::vector<std::uint32_t> order(corners.size() / 3);
    std::iota(order.begin(), order.end(), 0u);
    build(order, corners, 0);
    for (const std::uint32_t t : order)
        for (std::size_t c = 0; c < 3; ++c) corners_.push_back(corners[3 * t + c]);
}

std::uint32_t TriangleTree::build(std::span<std::uint32_t> order, const std::vector<Vec3>& corners,
                                  std::uint32_t first) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    Node node{Vec3(std::numeric_limits<double>::infinity()), Vec3(-std::numeric_limits<double>::infinity()), first, 0};
    for (const std::uint32_t t : order)
        for (std::size_t c = 0; c < 3; ++c) {
            node.low = glm::min(node.low, corners[3 * t + c]);
            node.high = glm::max(node.high, corners[3 * t + c]);
        }
    if (order.size() <= leaf_triangles) {
        node.count = static_cast<std::uint32_t>(order.size());
        nodes_.push_back(node);
        return at;
    }
    nodes_.push_back(node);
    const Vec3 extent = node.high - node.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto middle = [&](std::uint32_t t) {
        return corners[3 * t][axis] + corners[3 * t + 1][axis] + corners[3 * t + 2][axis];
    };
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = middle(a), y = middle(b);
                         return x < y || (x == y && a < b);
                     });
    build(order.first(half), corners, first);
    nodes_[at].first = build(order.subspan(half), corners, first + static_cast<std::uint32_t>(half));
    return at;
}

TriangleTree::Near TriangleTree::nearest(const Vec3& p, double within) const noexcept {
    Near best;
    if (nodes_.empty()) return best;
    double least2 = within * within;
    std::uint32_t stack[most_levels];
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t at = stack[--depth];
        const Node& node = nodes_[at];
        if (!(distance2(p, node.low, node.high) < least2)) continue;
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
            const Vec3* c = &corners_[3 * std::size_t(t)];
            const Vec3 point = closest_on_triangle(p, c[0], c[1], c[2]);
            const double d2 = glm::dot(p - point, p - point);
            if (d2 < least2) least2 = d2, best = {point, std::sqrt(d2)};
        }
        if (node.count > 0) continue;
        // The nearer child is looked at first.
        std::uint32_t a = at + 1, b = node.first;
        if (distance2(p, nodes_[a].low, nodes_[a].high) < distance2(p, nodes_[b].low, nodes_[b].high)) std::swap(a, b);
        stack[depth++] = a;
        stack[depth++] = b;
    }
    return best;
}

std::size_t TriangleTree::all_near(const Vec3& p, double within, std::span<Near> found) const noexcept {
    std::size_t count = 0, depth = 0;
    if (nodes_.empty()) return 0;
    std::uint32_t stack[most_levels];
    stack[depth++] = 0;
    while (depth > 0 && count < found.size()) {
        const std::uint32_t at = stack[--depth];
        const Node& node = nodes_[at];
        if (!(distance2(p, node.low, node.high) < within * within)) continue;
        for (std::uint32_t t = node.first; t < node.first + node.count && count < found.size(); ++t) {
            const Vec3* c = &corners_[3 * std::size_t(t)];
            const Vec3 point = closest_on_triangle(p, c[0], c[1], c[2]);
            const double distance = glm::length(p - point);
            if (distance < within) found[count++] = {point, distance};
        }
        if (node.count > 0) continue;
        stack[depth++] = node.first;
        stack[depth++] = at + 1;
    }
    return count;
}

double TriangleTree::cast(const Vec3& a, const Vec3& b) const noexcept {
    double first = 1.0;
    if (nodes_.empty()) return first;
    const Vec3 way = b - a;
    std::uint32_t stack[most_levels];
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t at = stack[--depth];
        const Node& node = nodes_[at];
        if (!meets(a, way, first, node.low, node.high)) continue;
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
            first = std::min(first, meets_at(a, way, &corners_[3 * std::size_t(t)]));
        if (node.count > 0) continue;
        stack[depth++] = node.first;
        stack[depth++] = at + 1;
    }
    return first;
}

}  // namespace tactus

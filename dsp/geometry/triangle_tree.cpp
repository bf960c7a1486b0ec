// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/triangle_tree.hpp"

#include "dsp/geometry/ball_sweep.hpp"
#include "dsp/geometry/closest_point.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tactus::geometry {

namespace {

constexpr std::size_t leaf_triangles = 4;
// Halving 2^31 triangles down to leaves of four needs 30 levels.
constexpr std::size_t max_levels = 64;

double distance2(const Vec3& p, const Vec3& low, const Vec3& high) {
    const Vec3 d = p - glm::clamp(p, low, high);
    return glm::dot(d, d);
}

/// True if the plane of a triangle, and so the triangle, is farther than the square root of `distance2`. Cheaper than
/// the closest point, and decides where the ball of a search touches a flat face. The margin exceeds rounding errors,
/// so that no closest point changes; of slivers, whose planes are inaccurate, it is never true.
bool is_plane_beyond(const Vec3& p, const Vec3* corner, double distance2) {
    const Vec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0], face = glm::cross(ab, ac);
    const double face2 = glm::dot(face, face), above = glm::dot(face, p - corner[0]);
    return above * above > 1.000001 * distance2 * face2 && face2 > 1e-12 * glm::dot(ab, ab) * glm::dot(ac, ac);
}

/// True when the segment a + t (b − a), 0 ≤ t ≤ most, meets the box.
bool meets(const Vec3& a, const Vec3& translation, double most, const Vec3& low, const Vec3& high) {
    double from = 0.0, to = most;
    for (int axis = 0; axis < 3; ++axis) {
        if (translation[axis] == 0.0) {
            if (a[axis] < low[axis] || a[axis] > high[axis]) return false;
            continue;
        }
        const double t0 = (low[axis] - a[axis]) / translation[axis], t1 = (high[axis] - a[axis]) / translation[axis];
        from = std::max(from, std::min(t0, t1));
        to = std::min(to, std::max(t0, t1));
    }
    return from <= to;
}

/// Facets that meet at a smaller angle than this belong to a round surface.
constexpr double round_cosine = 0.94;
/// Edges and areas below this share of the typical ones are slivers; rounding errors decide their directions.
constexpr double sliver = 0.1;

/// For each vertex a representative of all vertices connected to it by edges shorter than `length`.
std::vector<std::size_t> joined(const TriangleSurface& surface, double length) {
    std::vector<std::size_t> of(surface.vertices.size());
    std::iota(of.begin(), of.end(), std::size_t(0));
    const auto root = [&of](std::size_t v) {
        while (of[v] != v) v = of[v] = of[of[v]];
        return v;
    };
    for (const auto& t : surface.triangles)
        for (std::size_t e = 0; e < 3; ++e) {
            const auto a = static_cast<std::size_t>(t[e]), b = static_cast<std::size_t>(t[(e + 1) % 3]);
            if (!(glm::length(surface.vertices[a] - surface.vertices[b]) < length)) continue;
            const std::size_t x = root(a), y = root(b);
            of[std::max(x, y)] = std::min(x, y);
        }
    for (std::size_t v = 0; v < of.size(); ++v) of[v] = root(v);
    return of;
}

/// Unit normals at the corners of all triangles: the area-weighted mean of the triangles that meet there, or zero where
/// one of them deviates too much. Corners that nearly coincide, as in iso surfaces, are merged; slivers are
/// ignored.
std::vector<Vec3> corner_normals(const TriangleSurface& surface) {
    const auto at = [&](int v) { return surface.vertices[static_cast<std::size_t>(v)]; };
    std::vector<Vec3> face;
    double area2 = 0.0;
    for (const auto& t : surface.triangles) {
        face.push_back(glm::cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])));
        area2 += glm::length(face.back()) / static_cast<double>(surface.triangles.size());
    }
    const std::vector<std::size_t> of = joined(surface, sliver * std::sqrt(area2));
    const auto corner = [&](std::size_t t, std::size_t c) {
        return of[static_cast<std::size_t>(surface.triangles[t][c])];
    };
    std::vector<Vec3> mean(of.size(), Vec3(0.0));
    for (std::size_t t = 0; t < face.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) mean[corner(t, c)] += face[t];
    for (Vec3& n : mean) n = n == Vec3(0.0) ? n : glm::normalize(n);
    std::vector<std::uint8_t> is_sharp(of.size());
    for (std::size_t t = 0; t < face.size(); ++t) {
        const double size = glm::length(face[t]);
        for (std::size_t c = 0; c < 3; ++c)
            if (size > sliver * area2 && glm::dot(face[t], mean[corner(t, c)]) < round_cosine * size)
                is_sharp[corner(t, c)] = 1;
    }
    std::vector<Vec3> normals;
    for (std::size_t t = 0; t < face.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) normals.push_back(is_sharp[corner(t, c)] ? Vec3(0.0) : mean[corner(t, c)]);
    return normals;
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
    const std::vector<Vec3> normals = corner_normals(surface);
    for (const std::uint32_t t : order)
        for (std::size_t c = 0; c < 3; ++c) {
            corners_.push_back(corners[3 * t + c]);
            normals_.push_back(normals[3 * t + c]);
        }
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

TriangleTree::Near TriangleTree::near_on(std::size_t triangle, const Vec3& p) const noexcept {
    const Vec3 *c = &corners_[3 * triangle], *n = &normals_[3 * triangle];
    const Vec3 point = closest_on_triangle(p, c[0], c[1], c[2]);
    Near near{point, glm::length(p - point), Vec3(0.0)};
    const Vec3 face = glm::cross(c[1] - c[0], c[2] - c[0]);
    const double area2 = glm::dot(face, face);
    if (n[0] == Vec3(0.0) || n[1] == Vec3(0.0) || n[2] == Vec3(0.0) || !(area2 > 0.0)) return near;
    const double v = glm::dot(glm::cross(point - c[0], c[2] - c[0]), face) / area2,
                 w = glm::dot(glm::cross(c[1] - c[0], point - c[0]), face) / area2;
    const Vec3 mean = (1.0 - v - w) * n[0] + v * n[1] + w * n[2];
    const double length = glm::length(mean);
    if (length > 0.5 && length < 2.0) near.normal = mean / length;
    return near;
}

TriangleTree::Near TriangleTree::nearest(const Vec3& p, double within, Budget& budget) const noexcept {
    if (nodes_.empty()) return {};
    double least2 = within * within;
    std::size_t best = size();
    struct Entry {
        std::uint32_t node;
        double distance2;  // of its box
    };
    Entry stack[max_levels];
    std::size_t depth = 0;
    stack[depth++] = {0, distance2(p, nodes_[0].low, nodes_[0].high)};
    while (depth > 0) {
        const Entry entry = stack[--depth];
        if (!(entry.distance2 < least2)) continue;
        const Node& node = nodes_[entry.node];
        if (!budget.spend(node.count)) return {};
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
            const Vec3* c = &corners_[3 * std::size_t(t)];
            if (is_plane_beyond(p, c, least2)) continue;
            const Vec3 point = closest_on_triangle(p, c[0], c[1], c[2]);
            const double d2 = glm::dot(p - point, p - point);
            if (d2 < least2) least2 = d2, best = t;
        }
        if (node.count > 0) continue;
        // The nearer child is visited first.
        Entry a{entry.node + 1, 0.0}, b{node.first, 0.0};
        a.distance2 = distance2(p, nodes_[a.node].low, nodes_[a.node].high);
        b.distance2 = distance2(p, nodes_[b.node].low, nodes_[b.node].high);
        if (a.distance2 < b.distance2) std::swap(a, b);
        stack[depth++] = a;
        stack[depth++] = b;
    }
    return best < size() ? near_on(best, p) : Near{};
}

std::size_t TriangleTree::all_near(const Vec3& p, double within, std::span<Near> found, Budget& budget) const noexcept {
    std::size_t count = 0, depth = 0;
    if (nodes_.empty()) return 0;
    std::uint32_t stack[max_levels];
    stack[depth++] = 0;
    while (depth > 0 && count < found.size()) {
        const std::uint32_t at = stack[--depth];
        const Node& node = nodes_[at];
        if (!(distance2(p, node.low, node.high) < within * within)) continue;
        if (!budget.spend(node.count)) return 0;
        for (std::uint32_t t = node.first; t < node.first + node.count && count < found.size(); ++t) {
            const Near near = near_on(t, p);
            if (near.distance < within) found[count++] = near;
        }
        if (node.count > 0) continue;
        stack[depth++] = node.first;
        stack[depth++] = at + 1;
    }
    return count;
}

double TriangleTree::sweep(const Vec3& from, const Vec3& translation, double radius, Budget& budget) const noexcept {
    double first = 1.0;
    const double length = glm::length(translation);
    if (nodes_.empty()) return first;
    std::uint32_t stack[max_levels];
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t at = stack[--depth];
        const Node& node = nodes_[at];
        // Most moves of a ball at rest on a surface are short: only what they reach counts.
        const double reach = 1.000001 * (radius + first * length) + 1e-12;
        if (!(distance2(from, node.low, node.high) < reach * reach)) continue;
        if (!meets(from, translation, first, node.low - Vec3(radius), node.high + Vec3(radius))) continue;
        if (!budget.spend(node.count)) return 0.0;
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
            const Vec3* c = &corners_[3 * std::size_t(t)];
            first = std::min(first, ball_meets(from, translation, radius, c[0], c[1], c[2]));
        }
        if (node.count > 0) continue;
        // The nearer child is visited first: what it stops shortens the search in the other.
        std::uint32_t near = at + 1, far = node.first;
        if (distance2(from, nodes_[far].low, nodes_[far].high) < distance2(from, nodes_[near].low, nodes_[near].high))
            std::swap(near, far);
        stack[depth++] = far;
        stack[depth++] = near;
    }
    return first;
}

}  // namespace tactus::geometry

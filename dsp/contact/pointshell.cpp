// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace tactus::contact {

namespace {

using Indices = std::vector<std::uint32_t>;

struct Extent {
    Vec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

    void add(const Vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

double distance2(const Vec3& a, const Vec3& b) { return glm::dot(a - b, a - b); }

/// Partitions the points along the longest axis: the `first_part` lowest come first (nth element).
void split(std::span<std::uint32_t> order, std::size_t first_part, std::span<const SurfacePoint> points) {
    Extent box;
    for (const std::uint32_t i : order) box.add(points[i].position);
    const Vec3 extent = box.high - box.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(first_part), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = points[a].position[axis], y = points[b].position[axis];
                         return x < y || (x == y && a < b);
                     });
}

/// Number of points of each child of a node: whole chunks, distributed as evenly as possible.
std::array<std::uint32_t, 4> shares(std::uint32_t points) {
    const std::uint32_t leaves = (points + chunk_points - 1) / chunk_points, parts = std::min(leaves, 4u);
    std::array<std::uint32_t, 4> share{};
    std::uint32_t left = points;
    for (std::uint32_t c = 0; c < parts; ++c) {
        share[c] = std::min(left, (leaves / parts + (c < leaves % parts)) * chunk_points);
        left -= share[c];
    }
    return share;
}

/// The nodes of the tree, level by level, and the points in the order of its leaves.
std::vector<ShellNode> grow(std::span<const SurfacePoint> points, Indices& order) {
    std::vector<ShellNode> nodes;
    nodes.push_back({.points = static_cast<std::uint32_t>(points.size())});
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::uint32_t first = nodes[n].first_point, count = nodes[n].points;
        const std::span<std::uint32_t> range = std::span(order).subspan(first, count);
        if (count <= chunk_points) {
            std::ranges::sort(range);
            continue;
        }
        const auto share = shares(count);
        const std::uint32_t half = share[0] + (share[2] ? share[1] : 0);
        split(range, half, points);
        if (share[2]) split(range.first(half), share[0], points);
        if (share[3]) split(range.subspan(half), share[2], points);
        nodes[n].first_child = static_cast<std::uint32_t>(nodes.size());
        std::uint32_t at = first;
        for (std::uint32_t c = 0; c < 4 && share[c]; ++c, ++nodes[n].children) {
            nodes.push_back({.first_point = at, .points = share[c]});
            at += share[c];
        }
    }
    return nodes;
}

/// Points of a chunk, and the number of points and area that each represents.
struct Held {
    Indices index;
    std::vector<double> count, area;
};

/// At most 64 of the candidates by farthest-point sampling, starting with the one nearest to `start`. Each candidate is
/// represented by the nearest chosen one.
Held thinned(const Held& from, const std::vector<Vec3>& position, const Vec3& start) {
    const std::size_t all = from.index.size();
    if (all <= chunk_points) return from;
    std::vector<double> nearest(all, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> owner(all, 0);
    std::vector<std::size_t> picks;
    std::size_t pick = 0;
    for (std::size_t i = 1; i < all; ++i)
        if (distance2(position[from.index[i]], start) < distance2(position[from.index[pick]], start)) pick = i;
    while (picks.size() < chunk_points) {
        for (std::size_t i = 0; i < all; ++i) {
            const double d = distance2(position[from.index[i]], position[from.index[pick]]);
            if (d < nearest[i]) nearest[i] = d, owner[i] = picks.size();
        }
        picks.push_back(pick);
        pick = static_cast<std::size_t>(std::ranges::max_element(nearest) - nearest.begin());
    }
    Held kept;
    for (const std::size_t i : picks) kept.index.push_back(from.index[i]);
    kept.count.assign(picks.size(), 0.0);
    kept.area.assign(picks.size(), 0.0);
    for (std::size_t i = 0; i < all; ++i) {
        kept.count[owner[i]] += from.count[i];
        kept.area[owner[i]] += from.area[i];
    }
    return kept;
}

ShellChunk chunk_of(const Held& held, const Pointshell& shell, const Vec3& centre) {
    ShellChunk chunk{};
    for (std::size_t n = 0; n < held.index.size(); ++n) {
        const Vec3 offset = shell.position[held.index[n]] - centre, normal = shell.normal[held.index[n]];
        chunk.x[n] = static_cast<float>(offset.x);
        chunk.y[n] = static_cast<float>(offset.y);
        chunk.z[n] = static_cast<float>(offset.z);
        chunk.nx[n] = static_cast<float>(normal.x);
        chunk.ny[n] = static_cast<float>(normal.y);
        chunk.nz[n] = static_cast<float>(normal.z);
        chunk.count[n] = static_cast<float>(held.count[n]);
        chunk.area[n] = static_cast<float>(held.area[n]);
    }
    return chunk;
}

/// Centres, radii and chunks, children before parents.
void fill_chunks(Pointshell& shell) {
    shell.chunks.resize(shell.nodes.size());
    std::vector<Held> held(shell.nodes.size());
    for (std::size_t n = shell.nodes.size(); n-- > 0;) {
        ShellNode& node = shell.nodes[n];
        Held candidates;
        for (std::uint32_t i = 0; node.children == 0 && i < node.points; ++i) {
            candidates.index.push_back(node.first_point + i);
            candidates.count.push_back(1.0);
            candidates.area.push_back(static_cast<double>(shell.area[node.first_point + i]));
        }
        for (std::uint32_t c = node.first_child; c < node.first_child + node.children; ++c) {
            candidates.index.insert(candidates.index.end(), held[c].index.begin(), held[c].index.end());
            candidates.count.insert(candidates.count.end(), held[c].count.begin(), held[c].count.end());
            candidates.area.insert(candidates.area.end(), held[c].area.begin(), held[c].area.end());
            held[c] = {};
        }
        Extent box;
        for (std::uint32_t i = 0; i < node.points; ++i) box.add(shell.position[node.first_point + i]);
        held[n] = thinned(candidates, shell.position, 0.5 * (box.low + box.high));
        const auto nearest = std::ranges::min_element(held[n].index, {}, [&](std::uint32_t i) {
            return distance2(shell.position[i], 0.5 * (box.low + box.high));
        });
        node.centre = shell.position[*nearest];
        for (std::uint32_t i = 0; i < node.points; ++i)
            node.radius = std::max(node.radius, distance2(shell.position[node.first_point + i], node.centre));
        node.radius = std::sqrt(node.radius);
        node.held = static_cast<std::uint32_t>(held[n].index.size());
        for (std::uint32_t c = 0; c < node.children; ++c) node.below += shell.nodes[node.first_child + c].held;
        shell.chunks[n] = chunk_of(held[n], shell, node.centre);
    }
}

}  // namespace

Pointshell make_pointshell(std::span<const SurfacePoint> points) {
    if (points.size() > (std::size_t(1) << 28))
        throw Error("a pointshell can hold at most 2^28 points; increase the spacing");
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i].position) || !is_finite(points[i].normal) || !(points[i].area >= 0.0) ||
            !std::isfinite(points[i].area))
            throw Error(fmt::format("point {} of a pointshell has a position, normal or area that is not finite", i));
    Pointshell shell;
    if (points.empty()) return shell;
    Indices order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    shell.nodes = grow(points, order);
    shell.position.reserve(points.size());
    for (const std::uint32_t i : order) {
        const double length = glm::length(points[i].normal);
        shell.position.push_back(points[i].position);
        shell.normal.push_back(length > 0.0 ? points[i].normal / length : Vec3(0.0));
        shell.area.push_back(static_cast<float>(points[i].area));
        shell.label.push_back(points[i].label);
    }
    fill_chunks(shell);
    for (const Vec3& p : shell.position) {
        shell.reach = std::max(shell.reach, glm::length(p));
        shell.centroid += p;
    }
    const auto count = static_cast<double>(shell.size());
    shell.centroid /= count;
    double sum = 0.0;
    for (const Vec3& p : shell.position) sum += distance2(p, shell.centroid);
    shell.gyration = std::sqrt(sum / count);
    return shell;
}

}  // namespace tactus::contact

// SPDX-License-Identifier: Apache-2.0
// Topology and volume of a mesh, for tests.
#pragma once

#include "dsp/geometry/iso_surface.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <vector>

namespace tactus::test {

/// "none", or the number of edges that do not have two triangles that traverse them in opposite directions.
inline std::string flaws_of(const geometry::TriangleSurface& surface) {
    std::vector<std::array<int, 3>> edges;  // lesser, greater, direction
    for (const auto& t : surface.triangles)
        for (std::size_t n = 0; n < 3; ++n) {
            const int a = t[n], b = t[(n + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b});
        }
    std::ranges::sort(edges);
    int flaws = edges.empty() ? 1 : 0;
    for (std::size_t n = 0; n < edges.size();) {
        std::size_t end = n;
        while (end < edges.size() && edges[end][0] == edges[n][0] && edges[end][1] == edges[n][1]) ++end;
        flaws += end - n != 2 || edges[n][2] == edges[n + 1][2];
        n = end;
    }
    return flaws == 0 ? "none" : std::to_string(flaws);
}

/// Connected through vertices.
inline int parts_of(const geometry::TriangleSurface& surface) {
    std::vector<int> of(surface.vertices.size());
    std::iota(of.begin(), of.end(), 0);
    const auto root = [&](int v) {
        while (of[static_cast<std::size_t>(v)] != v)
            v = of[static_cast<std::size_t>(v)] = of[static_cast<std::size_t>(of[static_cast<std::size_t>(v)])];
        return v;
    };
    for (const auto& t : surface.triangles)
        for (const int v : t) of[static_cast<std::size_t>(root(v))] = root(t[0]);
    int parts = 0;
    std::vector<char> is_used(of.size(), 0);
    for (const auto& t : surface.triangles) is_used[static_cast<std::size_t>(root(t[0]))] = 1;
    for (const char used : is_used) parts += used;
    return parts;
}

inline double volume_of(const geometry::TriangleSurface& surface) {
    double sum = 0.0;
    for (const auto& t : surface.triangles) {
        const auto at = [&](std::size_t n) { return surface.vertices[static_cast<std::size_t>(t[n])]; };
        sum += glm::dot(at(0), glm::cross(at(1), at(2))) / 6.0;
    }
    return sum;
}

}  // namespace tactus::test

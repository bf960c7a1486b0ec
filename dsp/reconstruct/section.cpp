// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruct/section.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace tactus::reconstruct {

std::vector<Vec3> section_points(const geometry::TriangleSurface& surface, const Plane& plane, const Vec3* near) {
    std::vector<double> height;
    height.reserve(surface.vertices.size());
    for (const Vec3& v : surface.vertices) height.push_back(glm::dot(plane.normal, v - plane.origin));
    std::map<std::pair<int, int>, std::size_t> of_edge;
    std::vector<Vec3> points;
    std::vector<std::size_t> outline;  // union-find: points of a triangle belong together
    const auto root = [&](std::size_t n) {
        while (outline[n] != n) n = outline[n];
        return n;
    };
    for (const auto& triangle : surface.triangles) {
        std::array<std::size_t, 2> met{};
        std::size_t count = 0;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto [a, b] = std::minmax(triangle[corner], triangle[(corner + 1) % 3]);
            const double ha = height[static_cast<std::size_t>(a)], hb = height[static_cast<std::size_t>(b)];
            // A vertex on the plane counts as above, so that every outline is closed.
            if ((ha < 0.0) == (hb < 0.0)) continue;
            const auto [entry, is_new] = of_edge.insert({{a, b}, points.size()});
            if (is_new) {
                const double t = ha / (ha - hb);
                points.push_back(glm::mix(surface.vertices[static_cast<std::size_t>(a)],
                                          surface.vertices[static_cast<std::size_t>(b)], t));
                outline.push_back(outline.size());
            }
            if (count < 2) met[count++] = entry->second;
        }
        if (count == 2) outline[root(met[0])] = root(met[1]);
    }
    if (near == nullptr || points.empty()) return points;
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < points.size(); ++n)
        if (const double d = glm::length(points[n] - *near); d < least) least = d, nearest = n;
    const std::size_t wanted = root(nearest);
    std::vector<Vec3> chosen;
    for (std::size_t n = 0; n < points.size(); ++n)
        if (root(n) == wanted) chosen.push_back(points[n]);
    return chosen;
}

}  // namespace tactus::reconstruct

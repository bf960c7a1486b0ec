// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/bodies.hpp"

#include "dsp/core/constants.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace tactus::reconstruction {

namespace {

using geometry::TriangleSurface;
using Triangle = std::array<int, 3>;

const Vec3& corner(const TriangleSurface& surface, int n) { return surface.vertices[static_cast<std::size_t>(n)]; }

struct Shell {
    std::size_t root = 0;
    std::vector<Triangle> triangles;
    Vec3 low{infinity}, high{-infinity};
    double volume = 0.0;  // m³, signed
};

double volume_about(const TriangleSurface& surface, const std::vector<Triangle>& triangles, const Vec3& middle) {
    double sum = 0.0;
    for (const Triangle& t : triangles)
        sum += glm::dot(corner(surface, t[0]) - middle,
                        glm::cross(corner(surface, t[1]) - middle, corner(surface, t[2]) - middle)) /
               6.0;
    return sum;
}

std::vector<Shell> shells_of(const TriangleSurface& surface) {
    std::vector<std::size_t> part(surface.vertices.size());
    std::iota(part.begin(), part.end(), std::size_t{0});
    const auto root = [&](int n) {
        auto at = static_cast<std::size_t>(n);
        while (part[at] != at) at = part[at] = part[part[at]];
        return at;
    };
    for (const Triangle& t : surface.triangles)
        for (const int n : t) part[root(n)] = root(t[0]);
    std::map<std::size_t, std::size_t> number;
    std::vector<Shell> shells;
    for (const Triangle& t : surface.triangles) {
        const auto [entry, is_new] = number.insert({root(t[0]), shells.size()});
        if (is_new) shells.emplace_back().root = entry->first;
        Shell& shell = shells[entry->second];
        shell.triangles.push_back(t);
        for (const int n : t) {
            shell.low = glm::min(shell.low, corner(surface, n));
            shell.high = glm::max(shell.high, corner(surface, n));
        }
    }
    for (Shell& shell : shells) shell.volume = volume_about(surface, shell.triangles, 0.5 * (shell.low + shell.high));
    return shells;
}

/// Even-odd rule along a ray that is parallel to no axis, since faces and edges of many meshes are. An edge is met
/// or not met in the same way from both of its triangles.
bool encloses(const TriangleSurface& surface, const Shell& shell, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < shell.low[axis] || p[axis] > shell.high[axis]) return false;
    const auto along = [&](int n) {
        const Vec3 d = corner(surface, n) - p;
        return Vec3(d.x + 0.137 * d.z, d.y + 0.071 * d.z, d.z);
    };
    bool is_inside = false;
    for (const Triangle& t : shell.triangles) {
        const std::array<Vec3, 3> at{along(t[0]), along(t[1]), along(t[2])};
        bool is_met = false;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t d = (c + 1) % 3;
            const bool is_ordered = t[c] < t[d];
            const Vec3 &a = at[is_ordered ? c : d], &b = at[is_ordered ? d : c];
            if ((a.y < 0.0) != (b.y < 0.0) && a.x - a.y * (b.x - a.x) / (b.y - a.y) > 0.0) is_met = !is_met;
        }
        if (!is_met) continue;
        const Vec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
        if (normal.z != 0.0 && glm::dot(normal, at[0]) / normal.z > 0.0) is_inside = !is_inside;
    }
    return is_inside;
}

Vec3 farthest_from(const TriangleSurface& surface, const Shell& shell, std::span<const Plane> cuts) {
    Vec3 best = corner(surface, shell.triangles.front()[0]);
    double greatest = -1.0;
    for (const Triangle& t : shell.triangles)
        for (const int n : t) {
            double least = infinity;
            for (const Plane& cut : cuts)
                least = std::min(least, std::abs(glm::dot(cut.normal, corner(surface, n) - cut.origin)));
            if (least > greatest) greatest = least, best = corner(surface, n);
        }
    return best;
}

}  // namespace

double signed_volume(const TriangleSurface& surface) {
    Vec3 low(infinity), high(-infinity);
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    return surface.vertices.empty() ? 0.0 : volume_about(surface, surface.triangles, 0.5 * (low + high));
}

std::vector<std::size_t> bodies_of(const TriangleSurface& surface, std::span<const Plane> cuts) {
    const std::vector<Shell> shells = shells_of(surface);
    double all = 0.0;
    for (const Shell& shell : shells) all += shell.volume;
    const double outwards = all < 0.0 ? -1.0 : 1.0;
    std::vector<std::size_t> body(surface.vertices.size());
    std::iota(body.begin(), body.end(), std::size_t{0});
    for (const Shell& shell : shells) {
        const Shell* around = &shell;
        if (outwards * shell.volume < 0.0) {
            const Vec3 p = farthest_from(surface, shell, cuts);
            double least = infinity;
            for (const Shell& other : shells)
                if (const double v = outwards * other.volume; v > 0.0 && v < least && encloses(surface, other, p))
                    around = &other, least = v;
        }
        for (const Triangle& t : shell.triangles)
            for (const int n : t) body[static_cast<std::size_t>(n)] = around->root;
    }
    return body;
}

}  // namespace tactus::reconstruction

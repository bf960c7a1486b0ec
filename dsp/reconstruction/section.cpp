// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/section.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/closest_point.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace tactus::reconstruction {

namespace {

/// Two directions in the plane.
struct InPlane {
    Vec3 u, v;

    explicit InPlane(const Vec3& normal) {
        const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
        u = glm::normalize(glm::cross(normal, other));
        v = glm::cross(normal, u);
    }
};

/// Where a piece from a to b meets the line v = height along u; false when it does not. Half open, so that two pieces
/// that share a point on the line count once.
bool meets_line(const InPlane& in, const Vec3& a, const Vec3& b, double height, double& at) {
    const double va = glm::dot(in.v, a) - height, vb = glm::dot(in.v, b) - height;
    if ((va < 0.0) == (vb < 0.0)) return false;
    const double ua = glm::dot(in.u, a), ub = glm::dot(in.u, b);
    at = ua + (ub - ua) * va / (va - vb);
    return true;
}

/// Whether each outline, by its root, encloses `p`; even-odd rule.
std::vector<bool> enclosing(const Section& all, const std::vector<std::size_t>& root_of, const InPlane& in,
                            const Vec3& p) {
    const double height = glm::dot(in.v, p), from = glm::dot(in.u, p);
    std::vector<bool> encloses(all.points.size(), false);
    for (const auto& [a, b] : all.pieces)
        if (double at = 0.0; meets_line(in, all.points[a], all.points[b], height, at) && at > from)
            encloses[root_of[a]] = !encloses[root_of[a]];
    return encloses;
}

/// Of one limb, by the roots of its outlines: the outlines that enclose `near` or, where none does, the nearest one,
/// and all that lie inside them: marrow cavities, roots of teeth.
std::vector<bool> wanted_outlines(const Section& all, const std::vector<std::size_t>& root_of, const Plane& plane,
                                  const Vec3& near, double& away) {
    const InPlane in(plane.normal);
    std::vector<bool> wanted = enclosing(all, root_of, in, near);
    away = 0.0;
    if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) {
        std::size_t nearest = 0;
        away = infinity;
        for (const auto& [a, b] : all.pieces) {
            const double d = glm::length(geometry::closest_on_segment(near, all.points[a], all.points[b]) - near);
            if (d < away) away = d, nearest = root_of[a];
        }
        wanted[nearest] = true;
    }
    const std::vector<bool> limb = wanted;
    for (std::size_t n = 0; n < root_of.size(); ++n) {
        if (root_of[n] != n || limb[n]) continue;
        const std::vector<bool> around = enclosing(all, root_of, in, all.points[n]);
        for (std::size_t other = 0; other < around.size(); ++other)
            if (around[other] && limb[other]) wanted[n] = true;
    }
    return wanted;
}

/// Lines v = low + row * width along u, at row 0.5, 1.5, ...
struct Lines {
    double low, width;
    std::size_t count;

    double height(std::size_t row) const { return low + (static_cast<double>(row) + 0.5) * width; }
};

/// Sorted crossings of each line with the section. Each edge is tested only against the lines near it.
std::vector<std::vector<double>> crossings(const InPlane& in, const Section& section, const Lines& lines) {
    std::vector<std::vector<double>> places(lines.count);
    for (const auto& [a, b] : section.pieces) {
        const auto [least, greatest] =
            std::minmax({glm::dot(in.v, section.points[a]), glm::dot(in.v, section.points[b])});
        const double last = static_cast<double>(lines.count) - 1.0, from = (least - lines.low) / lines.width - 2.0,
                     to = (greatest - lines.low) / lines.width + 1.0;
        if (!(to >= 0.0 && from <= last)) continue;
        for (auto row = static_cast<std::size_t>(std::max(from, 0.0));
             row <= static_cast<std::size_t>(std::min(to, last)); ++row)
            if (double at = 0.0; meets_line(in, section.points[a], section.points[b], lines.height(row), at))
                places[row].push_back(at);
    }
    for (std::vector<double>& of_line : places) std::sort(of_line.begin(), of_line.end());
    return places;
}

}  // namespace

Section section_of(const geometry::TriangleSurface& surface, const Plane& plane, const Vec3* near) {
    std::vector<double> height;
    height.reserve(surface.vertices.size());
    for (const Vec3& v : surface.vertices) height.push_back(glm::dot(plane.normal, v - plane.origin));
    std::map<std::pair<int, int>, std::size_t> of_edge;
    Section all;
    std::vector<std::size_t> outline;  // union-find: points of a triangle belong together
    const auto root = [&](std::size_t n) {
        while (outline[n] != n) n = outline[n] = outline[outline[n]];
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
            const auto [entry, is_new] = of_edge.insert({{a, b}, all.points.size()});
            if (is_new) {
                const double t = ha / (ha - hb);
                all.points.push_back(glm::mix(surface.vertices[static_cast<std::size_t>(a)],
                                              surface.vertices[static_cast<std::size_t>(b)], t));
                all.edge.push_back({a, b});
                outline.push_back(outline.size());
            }
            if (count < 2) met[count++] = entry->second;
        }
        if (count != 2) continue;
        all.pieces.push_back(met);
        all.triangle.push_back(static_cast<std::size_t>(&triangle - surface.triangles.data()));
        outline[root(met[0])] = root(met[1]);
    }
    if (all.pieces.empty()) return {};
    std::vector<bool> wanted(all.points.size(), true);
    std::vector<std::size_t> root_of(all.points.size());
    for (std::size_t n = 0; n < root_of.size(); ++n) root_of[n] = root(n);
    Section chosen;
    if (near != nullptr) wanted = wanted_outlines(all, root_of, plane, *near, chosen.away);
    std::vector<std::size_t> number(all.points.size());
    for (std::size_t n = 0; n < all.points.size(); ++n)
        if (wanted[root_of[n]]) {
            number[n] = chosen.points.size();
            chosen.points.push_back(all.points[n]);
            chosen.edge.push_back(all.edge[n]);
            chosen.outline.push_back(root_of[n]);
        }
    double length = 0.0;
    for (std::size_t n = 0; n < all.pieces.size(); ++n) {
        const auto [a, b] = all.pieces[n];
        if (!wanted[root_of[a]]) continue;
        chosen.triangle.push_back(all.triangle[n]);
        chosen.pieces.push_back({number[a], number[b]});
        const double piece = glm::length(all.points[b] - all.points[a]);
        chosen.centre += 0.5 * piece * (all.points[a] + all.points[b]);
        length += piece;
    }
    chosen.centre = length > 0.0 ? chosen.centre / length : chosen.points.front();
    return chosen;
}

geometry::TriangleSurface parts_near_line(const geometry::TriangleSurface& surface, const Vec3& point,
                                          const Vec3& direction, double farthest) {
    std::vector<std::size_t> part(surface.vertices.size());
    std::iota(part.begin(), part.end(), std::size_t{0});
    const auto root = [&](std::size_t n) {
        while (part[n] != n) n = part[n] = part[part[n]];
        return n;
    };
    std::vector<bool> is_used(part.size(), false);
    for (const auto& t : surface.triangles)
        for (const int corner : t) {
            is_used[static_cast<std::size_t>(corner)] = true;
            part[root(static_cast<std::size_t>(corner))] = root(static_cast<std::size_t>(t[0]));
        }
    std::vector<double> sum(part.size(), 0.0), count(part.size(), 0.0);
    for (std::size_t n = 0; n < part.size(); ++n) {
        if (!is_used[n]) continue;
        sum[root(n)] += glm::length(glm::cross(surface.vertices[n] - point, direction));
        count[root(n)] += 1.0;
    }
    geometry::TriangleSurface chosen;
    std::vector<int> number(part.size(), -1);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < part.size(); ++n) {
        if (!is_used[n]) continue;
        const double mean = sum[root(n)] / count[root(n)];
        nearest = std::min(nearest, mean);
        if (!(mean <= farthest)) continue;
        number[n] = static_cast<int>(chosen.vertices.size());
        chosen.vertices.push_back(surface.vertices[n]);
    }
    if (chosen.vertices.empty())
        throw Error(fmt::format(
            "the donor's surface lies {:.2f} mm from the line on average, farther than {:.2f} mm; the donor must be "
            "straight and the line must follow it",
            nearest * 1e3, farthest * 1e3));
    for (const auto& t : surface.triangles)
        if (const auto at = [&](int corner) { return number[static_cast<std::size_t>(corner)]; }; at(t[0]) >= 0)
            chosen.triangles.push_back({at(t[0]), at(t[1]), at(t[2])});
    return chosen;
}

double overlap_area(const Section& a, const Section& b, const Plane& plane, double step) {
    if (a.pieces.empty() || b.pieces.empty() || !(step > 0.0)) return 0.0;
    const InPlane in(plane.normal);
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    for (const Section* section : {&a, &b}) {
        double least = std::numeric_limits<double>::infinity(), greatest = -least;
        for (const Vec3& p : section->points) {
            least = std::min(least, glm::dot(in.v, p));
            greatest = std::max(greatest, glm::dot(in.v, p));
        }
        low = std::max(low, least);
        high = std::min(high, greatest);
    }
    if (!(high > low)) return 0.0;
    // At most 2000 lines, however large the bone is.
    const double rows = std::clamp(std::ceil((high - low) / step), 1.0, 2000.0), width = (high - low) / rows;
    const Lines lines{low, width, static_cast<std::size_t>(rows)};
    const std::vector<std::vector<double>> places_a = crossings(in, a, lines), places_b = crossings(in, b, lines);
    double sum = 0.0;
    for (std::size_t row = 0; row < lines.count; ++row) {
        const std::vector<double>&of_a = places_a[row], &of_b = places_b[row];
        for (std::size_t i = 0; i + 1 < of_a.size(); i += 2)
            for (std::size_t j = 0; j + 1 < of_b.size(); j += 2)
                sum += std::max(0.0, std::min(of_a[i + 1], of_b[j + 1]) - std::max(of_a[i], of_b[j]));
    }
    return sum * width;
}

}  // namespace tactus::reconstruction

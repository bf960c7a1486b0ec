// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/plan_gaps.hpp"

#include "dsp/fit/gap.hpp"
#include "dsp/fit/mutual_gap.hpp"
#include "dsp/fit/overlap.hpp"
#include "tools/report/plan/colour_bar.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::report {

namespace {

/// Colour map of the gap: blue for overlap, white for contact, red for a gap of 1 mm, grey for no neighbour.
Vec3 gap_colour(double distance) {
    if (!std::isfinite(distance)) return Vec3(0.62);
    const double t = std::clamp(distance / 1e-3, -0.5, 1.0);
    return t < 0.0 ? glm::mix(Vec3(0.97), Vec3(0.10, 0.30, 0.85), -2.0 * t)
                   : glm::mix(Vec3(0.97), Vec3(0.80, 0.10, 0.10), t);
}

Drawing gap_legend() {
    return colour_bar([](double share) { return gap_colour(share * 1.5e-3 - 0.5e-3); }, "overlap of 0.5 mm or more",
                      "gap of 1 mm or more", "White: contact; grey: no neighbour within 3 mm");
}

/// Distances of the vertices of a fragment from the other one, each by its own normal: the two sides of thin bone do
/// not mix. A vertex unlike most of those around it takes their middle value.
std::vector<float> vertex_gaps(const DrawnPlan& c, std::size_t i, std::size_t j) {
    const mesh::Mesh& mesh = c.meshes[i];
    std::vector<contact::SurfacePoint> vertices(mesh.vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        vertices[v].position = mesh.vertices[v], vertices[v].normal = mesh.normals[v];
    std::vector<float> gaps = fit::gap_between(vertices, c.pose(i), c.fragments[j].map, c.pose(j)).distance;
    std::vector<std::vector<std::size_t>> around(gaps.size());
    for (const auto& triangle : mesh.triangles)
        for (std::size_t corner = 0; corner < 3; ++corner)
            around[static_cast<std::size_t>(triangle[corner])].push_back(
                static_cast<std::size_t>(triangle[(corner + 1) % 3]));
    std::vector<float> near;
    for (int pass = 0; pass < 3; ++pass) {
        const std::vector<float> before = gaps;
        for (std::size_t v = 0; v < gaps.size(); ++v) {
            if (around[v].size() < 3) continue;
            near.clear();
            for (const std::size_t n : around[v]) near.push_back(before[n]);
            std::ranges::sort(near);
            const float middle = near[near.size() / 2];
            if (std::isfinite(middle) != std::isfinite(before[v])) gaps[v] = middle;
        }
    }
    return gaps;
}

/// A fragment coloured by the distance to the other one, seen from the other one; none when nothing faces it.
std::optional<render::LabelledPicture> gap_map(const DrawnPlan& c, std::size_t i, std::size_t j) {
    display::PictureMesh mesh = placed(c.meshes[i], c.pose(i), Vec3(0.0));
    const std::vector<float> gaps = vertex_gaps(c, i, j);
    Vec3 towards(0.0);
    for (std::size_t v = 0; v < gaps.size(); ++v) {
        const Vec3 colour = gap_colour(static_cast<double>(gaps[v]));
        for (int axis = 0; axis < 3; ++axis)
            mesh.colours[3 * v + static_cast<std::size_t>(axis)] = static_cast<float>(colour[axis]);
        if (std::isfinite(gaps[v])) towards += c.pose(i).rotate(c.meshes[i].normals[v]);
    }
    if (!(glm::length(towards) > 0.0)) return std::nullopt;
    const Vec3 direction = -glm::normalize(towards);
    const Vec3 tilted = std::abs(direction.z) > 0.95 ? glm::normalize(direction + Vec3(0.3, 0.0, 0.0)) : direction;
    return render::labelled_picture({mesh}, tilted, fmt::format("{}, seen from {}", c.name(i), c.name(j)));
}

}  // namespace

PlanGaps gaps_of(const DrawnPlan& c) {
    PlanGaps found;
    for (std::size_t i = 0; i < c.fragments.size(); ++i)
        for (std::size_t j = i + 1; j < c.fragments.size(); ++j) {
            if (!c.is_shown(i) || !c.is_shown(j)) continue;
            const fit::PlacedBone a = analysis::placed_bone(c.fragments[i], c.pose(i)),
                                  b = analysis::placed_bone(c.fragments[j], c.pose(j));
            const fit::MutualGap gap = fit::mutual_gap(a, b);
            const double overlap =
                fit::overlap_volume(c.fragments[i].map.grid, c.pose(i), c.fragments[j].map, c.pose(j));
            if (!(gap.facing > 5e-6)) continue;
            found.table.rows.push_back(
                {c.name(i), c.name(j), fmt::format("{:.0f}", gap.facing * 1e6),
                 fmt::format("{:.0f}", gap.contact * 1e6), fmt::format("{:.2f}", analysis::shown_mm(gap.median * 1e3)),
                 fmt::format("{:.2f}", analysis::shown_mm(gap.p95 * 1e3)), fmt::format("{:.2f}", gap.deepest * 1e3),
                 fmt::format("{:.1f}", overlap * 1e9)});
            if (!(gap.facing > 20e-6)) continue;
            if (auto map = gap_map(c, i, j)) found.maps.pictures.push_back(*std::move(map));
        }
    return found;
}

void add_gaps(const PlanGaps& found, std::vector<ReportBlock>& out) {
    out.emplace_back(Heading{"Gaps and overlaps"});
    if (found.table.rows.empty()) {
        out.emplace_back(Paragraph{"No two fragments face each other within 3 mm."});
        return;
    }
    out.emplace_back(found.table);
    if (found.maps.pictures.empty()) return;
    out.emplace_back(gap_legend());
    out.emplace_back(found.maps);
}

}  // namespace tactus::report

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/plan_scenes.hpp"

#include "dsp/fit/gap.hpp"
#include "tools/render/flap_scene.hpp"
#include "tools/render/surface_map.hpp"
#include "tools/report/plan/colour_bar.hpp"
#include "tools/report/plan/plan_result.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

std::vector<display::PictureMesh> scene_of(const DrawnPlan& c, const plan::PlanState& state) {
    std::vector<display::PictureMesh> meshes;
    for (std::size_t n = 0; n < c.meshes.size(); ++n)
        if (c.is_shown(n))
            meshes.push_back(
                placed(c.meshes[n], state.arrangement.pose(static_cast<int>(n)), c.plan.fragments[n].colour));
    for (const analysis::VesselClearance& v : c.vessels)
        meshes.push_back(render::tube_mesh(v.vessel->points, v.vessel->radius, colour_of(*v.vessel)));
    return meshes;
}

std::vector<render::PictureLabel> labels_of(const DrawnPlan& c, const plan::PlanState& state) {
    std::vector<render::PictureLabel> labels;
    for (std::size_t n = 0; n < c.meshes.size(); ++n)
        if (c.is_shown(n))
            labels.push_back({c.name(n), state.arrangement.pose(static_cast<int>(n)).apply(c.middle(n)),
                              c.plan.fragments[n].colour});
    for (const analysis::VesselClearance& v : c.vessels)
        labels.push_back({v.vessel->name, v.vessel->points[v.vessel->points.size() / 2], colour_of(*v.vessel)});
    return labels;
}

/// Colour map of the gap: blue for overlap, white for contact, red for a gap of 1 mm, grey for no neighbour.
Vec3 gap_colour(double distance) {
    if (!std::isfinite(distance)) return Vec3(0.62);
    const double t = std::clamp(distance / 1e-3, -0.5, 1.0);
    return t < 0.0 ? glm::mix(Vec3(0.97), Vec3(0.10, 0.30, 0.85), -2.0 * t)
                   : glm::mix(Vec3(0.97), Vec3(0.80, 0.10, 0.10), t);
}

display::Figure gap_legend(const DrawnPlan&) {
    return colour_bar([](double share) { return gap_colour(share * 1.5e-3 - 0.5e-3); }, "overlap of 0.5 mm or more",
                      "gap of 1 mm or more");
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

constexpr Vec3 from_front(0.25, 1.0, -0.35), from_behind(-0.35, -1.0, -0.3), from_above(0.1, 0.3, -1.0);

std::vector<render::LabelledPicture> scenes(const DrawnPlan& c) {
    const plan::PlanState before = plan::state_of(c.plan, -1);
    const std::vector<display::PictureMesh> scanned = scene_of(c, before), planned = scene_of(c, c.state);
    if (planned.empty()) return {};
    const std::vector<render::PictureLabel> there = labels_of(c, before), here = labels_of(c, c.state);
    return {render::labelled_picture(scanned, from_front, "As scanned, from the front", there),
            render::labelled_picture(planned, from_front, "As planned, from the front", here),
            render::labelled_picture(planned, from_behind, "As planned, from behind", here),
            render::labelled_picture(planned, from_above, "As planned, from above", here)};
}

constexpr double map_range = 3e-3;  // m, of the fullest colour

/// All fragments as planned, coloured by their distance from the healthy side.
std::vector<render::LabelledPicture> healthy_maps(const DrawnPlan& c) {
    std::vector<display::PictureMesh> meshes;
    for (std::size_t n = 0; n < c.meshes.size(); ++n) {
        if (!c.is_shown(n)) continue;
        meshes.push_back(placed(c.meshes[n], c.pose(n), Vec3(0.0)));
        std::vector<float>& colours = meshes.back().colours;
        for (std::size_t v = 0; v < c.meshes[n].vertices.size(); ++v) {
            const Vec3 colour =
                render::map_colour(c.healthy->distance(c.pose(n).apply(c.meshes[n].vertices[v])), map_range);
            for (int axis = 0; axis < 3; ++axis)
                colours[3 * v + static_cast<std::size_t>(axis)] = static_cast<float>(colour[axis]);
        }
    }
    return {render::labelled_picture(meshes, from_front, "from the front"),
            render::labelled_picture(meshes, from_behind, "from behind")};
}

std::vector<render::LabelledPicture> gap_maps(const DrawnPlan& c) {
    std::vector<render::LabelledPicture> maps;
    for (const analysis::PlanGap& g : c.gaps)
        if (g.gap.facing > 20e-6)
            if (auto map = gap_map(c, static_cast<std::size_t>(g.first), static_cast<std::size_t>(g.second)))
                maps.push_back(*std::move(map));
    return maps;
}

const Fields<DrawnPlan>& healthy_map_fields() {
    static const Fields<DrawnPlan> all =
        Fields<DrawnPlan>("distance from the healthy side")
            .titled([](const DrawnPlan& c) { return fmt::format("Distance from the {}", c.state.mirror->words()); })
            .figure(
                "distance from the target", [](const DrawnPlan&) { return true; },
                [](const DrawnPlan&) {
                    return colour_bar([](double share) { return render::map_colour(share * map_range, map_range); },
                                      "0 mm", fmt::format("{:g} mm or more", map_range * 1e3));
                })
            .pictures(healthy_maps);
    return all;
}

}  // namespace

const Fields<DrawnPlan>& scenes_fields() {
    static const Fields<DrawnPlan> all =
        Fields<DrawnPlan>("pictures of a plan")
            .remark([](const DrawnPlan& c) {
                return scene_of(c, c.state).empty()
                           ? "All fragments are hidden."
                           : "R, L, A, P, S, I: towards the right, left, front, back, head and feet of the patient. "
                             "The scale holds at the middle of the scene.";
            })
            .pictures(scenes)
            .child("", "distance from the healthy side", healthy_map_fields(),
                   [](const DrawnPlan& c) { return c.healthy ? &c : nullptr; });
    return all;
}

const Fields<DrawnPlan>& drawn_gaps_fields() {
    static const Fields<DrawnPlan> all =
        Fields<DrawnPlan>("gaps of a plan")
            .figure(
                "White: contact; grey: no neighbour within 3 mm",
                [](const DrawnPlan& c) {
                    return std::ranges::any_of(c.gaps, [](const auto& g) { return g.gap.facing > 20e-6; });
                },
                gap_legend)
            .pictures(gap_maps)
            .part(gaps_fields(), [](const DrawnPlan& c) { return named_gaps(c.plan, c.gaps); });
    return all;
}

}  // namespace tactus::report

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/drawn_plan.hpp"

#include "dsp/fit/mutual_gap.hpp"
#include "dsp/fit/overlap.hpp"
#include "dsp/geometry/coarse_surface.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/render/flap_scene.hpp"

#include <glm/geometric.hpp>

#include <cstdint>

namespace tactus::report {

namespace {

// Of a picture's mesh: more triangles than pixels show nothing, and the drawing of a whole hip in fine voxels takes a
// gigabyte.
constexpr std::size_t max_triangles = 150'000;

/// The surface of a drawing, simplified to at most max_triangles.
mesh::Mesh drawn_surface(const volume::Grid& distance) {
    mesh::Mesh full = mesh::surface_of(distance);
    if (full.triangles.size() <= max_triangles) return full;
    geometry::SurfacePatch fine;
    for (std::size_t v = 0; v < full.vertices.size(); ++v) {
        const glm::vec3 p(full.vertices[v]);
        fine.vertices.push_back({{p.x, p.y, p.z}, geometry::packed_normal(full.normals[v])});
    }
    for (const auto& t : full.triangles)
        for (const int v : t) fine.triangles.push_back(static_cast<std::uint32_t>(v));
    full = {};
    geometry::CoarseSurface simplifier;
    const auto& levels = simplifier.make(fine, {distance.origin, distance.spacing, 0});
    const geometry::SurfacePatch* level = &levels.back();
    for (const geometry::SurfacePatch& one : levels)
        if (one.triangles.size() / 3 <= max_triangles && one.triangles.size() > level->triangles.size()) level = &one;
    mesh::Mesh drawn;
    for (const geometry::SurfaceVertex& v : level->vertices) {
        drawn.vertices.emplace_back(v.position[0], v.position[1], v.position[2]);
        drawn.normals.push_back(glm::normalize(Vec3(v.normal[0], v.normal[1], v.normal[2])));
    }
    for (std::size_t n = 0; n + 2 < level->triangles.size(); n += 3)
        drawn.triangles.push_back({static_cast<int>(level->triangles[n]), static_cast<int>(level->triangles[n + 1]),
                                   static_cast<int>(level->triangles[n + 2])});
    return drawn;
}

std::vector<analysis::PlanGap> gaps_of(const DrawnPlan& c) {
    std::vector<analysis::PlanGap> found;
    for (std::size_t i = 0; i < c.fragments.size(); ++i)
        for (std::size_t j = i + 1; j < c.fragments.size(); ++j) {
            if (!c.is_shown(i) || !c.is_shown(j)) continue;
            const fit::PlacedBone a = analysis::placed_bone(c.fragments[i], c.pose(i)),
                                  b = analysis::placed_bone(c.fragments[j], c.pose(j));
            const fit::MutualGap gap = fit::mutual_gap(a, b);
            if (!(gap.facing > 5e-6)) continue;
            found.push_back({static_cast<int>(i), static_cast<int>(j), gap,
                             fit::overlap_volume(c.fragments[i].map.grid, c.pose(i), c.fragments[j].map, c.pose(j))});
        }
    return found;
}

}  // namespace

DrawnPlan draw_plan(const plan::CasePlan& plan, const std::filesystem::path& folder) {
    DrawnPlan c;
    c.plan = plan;
    c.state = plan::state_of(c.plan);
    c.fragments = analysis::load_fragments(plan, folder);
    c.to_healthy = analysis::healthy_residuals(c.state, folder, c.fragments);
    c.to_healthy.resize(c.fragments.size());
    c.healthy = analysis::healthy_side(c.state, folder);
    c.vessels = analysis::vessel_clearances(c.state, c.fragments);
    for (const analysis::CaseFragment& fragment : c.fragments) c.meshes.push_back(drawn_surface(fragment.map.grid));
    c.gaps = gaps_of(c);
    return c;
}

Vec3 DrawnPlan::middle(std::size_t n) const {
    Vec3 sum(0.0);
    const auto& points = fragments[n].bone.points;
    for (const contact::SurfacePoint& p : points) sum += p.position / static_cast<double>(points.size());
    return sum;
}

const Vec3& colour_of(const reconstruction::FlapVessel& vessel) {
    return vessel.kind == reconstruction::VesselKind::artery ? render::flap_artery_colour : render::flap_vein_colour;
}

display::PictureMesh placed(const mesh::Mesh& mesh, const Pose& pose, const Vec3& colour) {
    display::PictureMesh picture;
    for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
        const Vec3 v = pose.apply(mesh.vertices[n]), d = pose.rotate(mesh.normals[n]);
        for (int axis = 0; axis < 3; ++axis) {
            picture.positions.push_back(static_cast<float>(v[axis]));
            picture.normals.push_back(static_cast<float>(d[axis]));
            picture.colours.push_back(static_cast<float>(colour[axis]));
        }
    }
    for (const auto& triangle : mesh.triangles)
        for (const auto corner : triangle) picture.triangles.push_back(static_cast<std::uint32_t>(corner));
    return picture;
}

}  // namespace tactus::report

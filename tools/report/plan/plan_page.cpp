// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/plan_page.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/coarse_surface.hpp"
#include "tools/counted.hpp"
#include "tools/report/figures/html_report.hpp"
#include "tools/report/plan/plan_gaps.hpp"
#include "tools/report/plan/plan_scenes.hpp"
#include "tools/report/plan/plan_tables.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

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

}  // namespace

std::vector<ReportBlock> plan_blocks(const plan::CasePlan& plan, const std::vector<analysis::CaseWarning>& warnings,
                                     std::vector<analysis::CaseFragment> fragments,
                                     std::vector<std::optional<double>> to_healthy,
                                     const fit::RegistrationTarget* healthy, std::vector<ReportBlock> first) {
    DrawnPlan c;
    c.plan = plan;
    c.state = plan::state_of(c.plan);
    c.fragments = std::move(fragments);
    c.to_healthy = std::move(to_healthy);
    c.to_healthy.resize(c.fragments.size());
    c.vessels = analysis::vessel_clearances(c.state, c.fragments);
    for (const analysis::CaseFragment& fragment : c.fragments) c.meshes.push_back(drawn_surface(fragment.map.grid));
    std::vector<ReportBlock> out, pictures;
    PlanGaps found;
    try {
        found = gaps_of(c);
        add_pictures(c, pictures);
        if (healthy) add_mirror_maps(c, *healthy, pictures);
    } catch (const Error& error) {
        throw Error(fmt::format("the pictures cannot be made: {}", error.what()));
    }
    out.emplace_back(Paragraph{fmt::format("Alternative '{}', {}. Research use; not a medical device.",
                                           c.plan.alternatives[static_cast<std::size_t>(c.plan.current)].name,
                                           counted(c.fragments.size(), "fragment"))});
    add_warnings(warnings, out);
    std::ranges::move(first, std::back_inserter(out));
    add_connections(c, out);
    out.emplace_back(Heading{"Fragments"});
    out.emplace_back(fragments_table(c));
    add_vessels(c, out);
    add_mirror(c, out);
    std::ranges::move(pictures, std::back_inserter(out));
    add_gaps(found, out);
    out.emplace_back(Heading{"Poses"});
    out.emplace_back(Paragraph{"p_plan = R p_scan + t, LPS, mm; R as a unit quaternion w x y z."});
    out.emplace_back(places(c));
    add_steps(c, out);
    out.emplace_back(Heading{"Alternatives"});
    out.emplace_back(alternatives(c.plan));
    return out;
}

std::string plan_page(const plan::CasePlan& plan, const std::vector<analysis::CaseWarning>& warnings,
                      std::vector<analysis::CaseFragment> fragments, std::vector<std::optional<double>> to_healthy,
                      const fit::RegistrationTarget* healthy) {
    return html::page(
        plan.title, html_of(plan_blocks(plan, warnings, std::move(fragments), std::move(to_healthy), healthy), "plan"));
}

}  // namespace tactus::report

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/plan_scenes.hpp"

#include "tools/render/flap_scene.hpp"
#include "tools/render/surface_map.hpp"
#include "tools/report/plan/colour_bar.hpp"

#include <fmt/format.h>

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

}  // namespace

void add_pictures(const DrawnPlan& c, std::vector<ReportBlock>& out) {
    const plan::PlanState before = plan::state_of(c.plan, -1);
    const std::vector<display::PictureMesh> scanned = scene_of(c, before), planned = scene_of(c, c.state);
    const std::vector<render::PictureLabel> there = labels_of(c, before), here = labels_of(c, c.state);
    out.emplace_back(Heading{"Pictures"});
    if (planned.empty()) {
        out.emplace_back(Paragraph{"All fragments are hidden."});
        return;
    }
    out.emplace_back(
        Paragraph{"R, L, A, P, S, I: towards the right, left, front, back, head and feet of the patient. The scale "
                  "holds at the middle of the scene."});
    out.emplace_back(
        PictureGrid{{render::labelled_picture(scanned, Vec3(0.25, 1.0, -0.35), "As scanned, from the front", there),
                     render::labelled_picture(planned, Vec3(0.25, 1.0, -0.35), "As planned, from the front", here),
                     render::labelled_picture(planned, Vec3(-0.35, -1.0, -0.3), "As planned, from behind", here),
                     render::labelled_picture(planned, Vec3(0.1, 0.3, -1.0), "As planned, from above", here)}});
}

void add_mirror_maps(const DrawnPlan& c, const fit::RegistrationTarget& healthy, std::vector<ReportBlock>& out) {
    constexpr double range = 3e-3;  // m, of the fullest colour
    std::vector<display::PictureMesh> meshes;
    for (std::size_t n = 0; n < c.meshes.size(); ++n) {
        if (!c.is_shown(n)) continue;
        meshes.push_back(placed(c.meshes[n], c.pose(n), Vec3(0.0)));
        std::vector<float>& colours = meshes.back().colours;
        for (std::size_t v = 0; v < c.meshes[n].vertices.size(); ++v) {
            const Vec3 colour = render::map_colour(healthy.distance(c.pose(n).apply(c.meshes[n].vertices[v])), range);
            for (int axis = 0; axis < 3; ++axis)
                colours[3 * v + static_cast<std::size_t>(axis)] = static_cast<float>(colour[axis]);
        }
    }
    const std::string what = fmt::format("Distance from the {}", c.state.mirror->words());
    out.emplace_back(Heading{what});
    out.emplace_back(colour_bar([](double share) { return render::map_colour(share * range, range); }, "0 mm",
                                fmt::format("{:g} mm or more", range * 1e3), what));
    out.emplace_back(PictureGrid{{render::labelled_picture(meshes, Vec3(0.25, 1.0, -0.35), "from the front"),
                                  render::labelled_picture(meshes, Vec3(-0.35, -1.0, -0.3), "from behind")}});
}

}  // namespace tactus::report

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plan/drawn_plan.hpp"

#include "tools/render/flap_scene.hpp"

#include <cstdint>

namespace tactus::report {

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

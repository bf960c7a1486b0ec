// SPDX-License-Identifier: Apache-2.0
#include "tools/render/body_surface.hpp"

#include "dsp/core/stop.hpp"
#include "dsp/geometry/surface_net.hpp"
#include "tools/render/painted_points.hpp"

#include <glm/geometric.hpp>

#include <cstddef>

namespace tactus::render {

BodySurface make_body_surface(const observe::SeenBody& body, const contact::Voxmap& field, const Vec3& colour,
                              const Vec3& paint_colour) {
    PaintedPoints paint;
    for (std::size_t i = 0; i < body.points.size() && i < body.labels.size(); ++i)
        if (body.labels[i] == contact::surface_label::fracture)
            paint.add(body.points[i], field.smooth_sample(body.points[i]).gradient);
    const geometry::SurfaceNet net = geometry::surface_net(field.grid, 0.0f, false);
    BodySurface surface;
    surface.has_paint = !paint.empty();
    geometry::SurfacePatch& patch = surface.patch;
    for (const Vec3& vertex : net.vertices) {
        if (patch.vertices.size() % 1024 == 0) leave_if_stopped();
        const volume::Sample rough = field.sample(vertex);
        const double steep = glm::dot(rough.gradient, rough.gradient);
        const Vec3 at = steep > 0.25 ? vertex - rough.gradient * (rough.value / steep) : vertex;
        const Vec3 normal = field.smooth_sample(at).gradient;
        patch.vertices.push_back({{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
                                  geometry::packed_normal(normal),
                                  geometry::packed_colour(paint.covers(at, normal) ? paint_colour : colour)});
        surface.bounds.add(at);
    }
    for (const auto& triangle : net.triangles)
        for (const int corner : triangle) patch.triangles.push_back(static_cast<std::uint32_t>(corner));
    return surface;
}

}  // namespace tactus::render

// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/registration/vertex_points.hpp"

#include <glm/geometric.hpp>

#include <cstddef>

namespace tactus::fit {

std::vector<contact::SurfacePoint> vertex_points(const geometry::TriangleSurface& mesh) {
    std::vector<contact::SurfacePoint> points(mesh.vertices.size());
    for (std::size_t n = 0; n < points.size(); ++n) points[n] = {mesh.vertices[n], Vec3(0.0), 0.0, 0};
    for (const auto& t : mesh.triangles) {
        const auto corner = [&](std::size_t c) { return static_cast<std::size_t>(t[c]); };
        const Vec3 across = glm::cross(mesh.vertices[corner(1)] - mesh.vertices[corner(0)],
                                       mesh.vertices[corner(2)] - mesh.vertices[corner(0)]);
        for (std::size_t c = 0; c < 3; ++c) {
            points[corner(c)].normal += across;
            points[corner(c)].area += glm::length(across) / 6.0;
        }
    }
    std::erase_if(points, [](const contact::SurfacePoint& p) { return !(glm::length(p.normal) > 0.0); });
    for (contact::SurfacePoint& p : points) p.normal = glm::normalize(p.normal);
    return points;
}

}  // namespace tactus::fit

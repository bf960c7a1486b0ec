// SPDX-License-Identifier: Apache-2.0
#include "tools/render/triangle_patch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace tactus::render {

geometry::SurfacePatch triangle_patch(const geometry::TriangleSurface& surface,
                                      const std::array<std::uint8_t, 4>& colour) {
    geometry::SurfacePatch patch;
    std::vector<Vec3> normals(surface.vertices.size(), Vec3(0.0));
    for (const auto& t : surface.triangles) {
        const auto corner = [&](std::size_t n) { return surface.vertices[static_cast<std::size_t>(t[n])]; };
        const Vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
        for (const int v : t) {
            normals[static_cast<std::size_t>(v)] += normal;
            patch.triangles.push_back(static_cast<std::uint32_t>(v));
        }
    }
    for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        geometry::SurfaceVertex vertex;
        const double length = std::max(1e-30, glm::length(normals[v]));
        for (int axis = 0; axis < 3; ++axis) {
            vertex.position[static_cast<std::size_t>(axis)] = static_cast<float>(surface.vertices[v][axis]);
            vertex.normal[static_cast<std::size_t>(axis)] =
                static_cast<std::int16_t>(32767.0 * normals[v][axis] / length);
        }
        vertex.colour = colour;
        patch.vertices.push_back(vertex);
    }
    return patch;
}

}  // namespace tactus::render

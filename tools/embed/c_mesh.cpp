// SPDX-License-Identifier: Apache-2.0
#include "tools/embed/c_mesh.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace tactus::embed {

geometry::TriangleSurface surface_of(const tactus_mesh* mesh, const char* what) {
    if (!mesh || !mesh->vertices || !mesh->triangles || mesh->vertex_count == 0 || mesh->triangle_count == 0)
        throw Error(fmt::format("the {} mesh has no vertices or no triangles", what));
    constexpr std::size_t max_count = std::numeric_limits<int>::max();
    if (mesh->vertex_count > max_count || mesh->triangle_count > max_count)
        throw Error(fmt::format("the {} mesh has more than {} vertices or triangles", what, max_count));
    geometry::TriangleSurface surface;
    surface.vertices.reserve(mesh->vertex_count);
    for (std::size_t n = 0; n < mesh->vertex_count; ++n) {
        const double* const v = mesh->vertices + 3 * n;
        surface.vertices.emplace_back(v[0], v[1], v[2]);
        if (!is_finite(surface.vertices.back()))
            throw Error(fmt::format("vertex {} of the {} mesh is not finite", n, what));
    }
    Vec3 low = surface.vertices.front(), high = low;
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    const Vec3 size = high - low;
    const double extent = std::max({size.x, size.y, size.z});
    if (!(extent >= 1e-3 && extent <= 5.0))
        throw Error(fmt::format("the {} mesh is {:.3g} m across; vertices are in m, and a mesh is 1 mm to 5 m across",
                                what, extent));
    surface.triangles.reserve(mesh->triangle_count);
    for (std::size_t n = 0; n < mesh->triangle_count; ++n) {
        const std::int32_t* const t = mesh->triangles + 3 * n;
        for (int c = 0; c < 3; ++c)
            if (t[c] < 0 || static_cast<std::size_t>(t[c]) >= mesh->vertex_count)
                throw Error(fmt::format("triangle {} of the {} mesh has the vertex {}; there are {}", n, what, t[c],
                                        mesh->vertex_count));
        surface.triangles.push_back({t[0], t[1], t[2]});
    }
    return surface;
}

}  // namespace tactus::embed

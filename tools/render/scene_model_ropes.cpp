// SPDX-License-Identifier: Apache-2.0
// Ropes, such as vessels, as tubes coloured by their load.
#include "dsp/rope/rope_shape.hpp"
#include "tools/render/scene_colours.hpp"
#include "tools/render/scene_model.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::render {

using namespace scene_colours;

namespace {

constexpr std::size_t sides = 10;

Vec3 colour_of(const rope::RopeShape& shape, double load) {
    const Vec3& slack = shape.is_vein ? vein_colour : artery_colour;
    return slack + std::clamp(load, 0.0, 1.0) * (strained_colour - slack);
}

Vec3 point_of(const rope::RopeShape& shape, std::size_t n) {
    return {shape.points[n][0], shape.points[n][1], shape.points[n][2]};
}

void add_vertex(geometry::SurfacePatch& patch, const Vec3& position, const Vec3& normal, const Vec3& colour) {
    patch.vertices.push_back(
        {{static_cast<float>(position.x), static_cast<float>(position.y), static_cast<float>(position.z)},
         geometry::packed_normal(normal),
         geometry::packed_colour(colour, 1.0)});
}

/// An open tube of rings that are carried along without turning. Empty when a point is no number.
void add_tube(geometry::SurfacePatch& patch, const rope::RopeShape& shape) {
    const std::size_t count = std::min<std::size_t>(shape.count, rope::RopeShape::max_points);
    for (std::size_t n = 0; n < count; ++n)
        if (!is_finite(point_of(shape, n))) return;
    if (count < 2) return;
    Vec3 side(0.0);
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3 along = point_of(shape, std::min(n + 1, count - 1)) - point_of(shape, n > 0 ? n - 1 : 0);
        const double length = glm::length(along);
        const Vec3 z = length > 0.0 ? along / length : Vec3(0.0, 0.0, 1.0);
        side -= glm::dot(side, z) * z;
        if (!(glm::length(side) > 1e-6))
            side = glm::cross(z, std::abs(z.x) < 0.9 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0));
        side = glm::normalize(side);
        const Vec3 up = glm::cross(z, side);
        const double load = std::max(n > 0 ? shape.load[n - 1] : 0.0f, shape.load[n]);
        const auto first = static_cast<std::uint32_t>(patch.vertices.size());
        for (std::size_t k = 0; k < sides; ++k) {
            const double a = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sides);
            const Vec3 normal = std::cos(a) * side + std::sin(a) * up;
            add_vertex(patch, point_of(shape, n) + static_cast<double>(shape.radius) * normal, normal,
                       colour_of(shape, load));
        }
        if (n == 0) continue;
        for (std::uint32_t k = 0; k < sides; ++k) {
            const std::uint32_t next = (k + 1) % sides, low = first - sides;
            for (const std::uint32_t corner : {low + k, low + next, first + next, low + k, first + next, first + k})
                patch.triangles.push_back(corner);
        }
    }
}

}  // namespace

void SceneModel::show_ropes() {
    for (const auto& [node, port, course] : outline_.ropes) {
        const auto seen = observer_.latest<rope::RopeShape>(port);
        if (!seen || seen->value.count < 2) continue;
        const rope::RopeShape& shape = seen->value;
        if (!is_part_shown(node, colour_of(shape, 0.0))) continue;
        RopeMesh& rope = ropes_[port];
        if (rope.mesh < 0) rope.mesh = renderer_.meshes().make();
        if (rope.content != shape.content_hash) {
            patch_.vertices.clear();
            patch_.triangles.clear();
            add_tube(patch_, shape);
            renderer_.meshes().set_part(rope.mesh, 0, patch_);
            rope.bounds = display::bounds_of(patch_);
            rope.content = shape.content_hash;
        }
        part_of_mesh_.emplace_back(picture_.meshes.size(), node);
        show(rope.mesh, {}, rope.bounds);
        legend_.entries.push_back({fmt::format("{}: darker as it is stretched", node), colour_of(shape, 0.0)});
    }
}

}  // namespace tactus::render

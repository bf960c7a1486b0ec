// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/scene/body_surface.hpp"

#include "dsp/geometry/surface_net.hpp"

#include <glm/geometric.hpp>

#include <array>
#include <map>
#include <vector>

namespace tactus::picture {

namespace {

constexpr double painted_within = 0.9e-3;  // m from a painted point

/// Painted points by cells of a grid.
class Paint {
public:
    explicit Paint(const observe::SeenBody& body) {
        for (std::size_t i = 0; i < body.points.size() && i < body.labels.size(); ++i)
            if (body.labels[i] == contact::surface_label::fracture)
                cells_[cell_of(body.points[i])].push_back(body.points[i]);
    }
    bool empty() const { return cells_.empty(); }
    bool covers(const Vec3& at) const {
        const Key middle = cell_of(at);
        for (int n = 0; n < 27; ++n) {
            const auto found = cells_.find({middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1});
            if (found == cells_.end()) continue;
            for (const Vec3& point : found->second)
                if (glm::dot(point - at, point - at) < painted_within * painted_within) return true;
        }
        return false;
    }

private:
    using Key = std::array<int, 3>;
    static Key cell_of(const Vec3& at) {
        const Vec3 cell = glm::floor(at / painted_within);
        return {static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)};
    }
    std::map<Key, std::vector<Vec3>> cells_;
};

}  // namespace

BodySurface make_body_surface(const observe::SeenBody& body, const contact::Voxmap& field, const Vec3& colour,
                              const Vec3& paint_colour) {
    const Paint paint(body);
    const geometry::SurfaceNet net = geometry::surface_net(field.grid, 0.0f, false);
    BodySurface surface;
    surface.has_paint = !paint.empty();
    geometry::SurfacePatch& patch = surface.patch;
    for (const Vec3& vertex : net.vertices) {
        const volume::Sample rough = field.sample(vertex);
        const double steep = glm::dot(rough.gradient, rough.gradient);
        const Vec3 at = steep > 0.25 ? vertex - rough.gradient * (rough.value / steep) : vertex;
        patch.vertices.push_back({{static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
                                  geometry::packed_normal(field.smooth_sample(at).gradient),
                                  geometry::packed_colour(paint.covers(at) ? paint_colour : colour)});
        surface.bounds.add(at);
    }
    for (const auto& triangle : net.triangles)
        for (const int corner : triangle) patch.triangles.push_back(static_cast<std::uint32_t>(corner));
    return surface;
}

}  // namespace tactus::picture

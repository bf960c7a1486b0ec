// SPDX-License-Identifier: Apache-2.0
#include "devices/display/offscreen.hpp"

#include "devices/display/picture_maker.hpp"
#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::display {

namespace {

geometry::SurfacePatch patch_of(const PictureMesh& mesh) {
    const std::size_t vertices = mesh.positions.size() / 3;
    if (mesh.positions.size() != 3 * vertices || mesh.normals.size() != 3 * vertices ||
        mesh.colours.size() != 3 * vertices || mesh.triangles.size() % 3 != 0)
        throw Error("a mesh needs position, normal and colour per vertex, and three vertices per triangle");
    geometry::SurfacePatch patch;
    patch.triangles = mesh.triangles;
    for (std::size_t i = 0; i < 3 * vertices; i += 3) {
        const auto at = [i](const std::vector<float>& from) {
            return Vec3(static_cast<double>(from[i]), static_cast<double>(from[i + 1]),
                        static_cast<double>(from[i + 2]));
        };
        patch.vertices.push_back({{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]},
                                  geometry::packed_normal(at(mesh.normals)),
                                  geometry::packed_colour(at(mesh.colours))});
    }
    return patch;
}

}  // namespace

View fit_view(const Vec3& low, const Vec3& high, const Vec3& direction, const Vec3& up, double aspect) {
    View view;
    view.target = 0.5 * (low + high);
    view.up = up;
    const double half = 0.5 * view.vertical_field_of_view_rad;
    const double narrow = std::min(half, std::atan(std::tan(half) * aspect));
    const double radius = std::max(0.5 * glm::length(high - low), 1e-6);
    view.eye = view.target - glm::normalize(direction) * (radius / std::sin(narrow));
    return view;
}

Image render_picture(std::span<const PictureMesh> meshes, const View& view, int width, int height) {
    std::vector<geometry::SurfacePatch> patches;
    for (const PictureMesh& mesh : meshes) patches.push_back(patch_of(mesh));
    PictureMaker maker(width, height);
    Picture picture;
    for (const geometry::SurfacePatch& patch : patches) {
        picture.meshes.push_back({maker.renderer().meshes().make(), {}, 1.0, false});
        maker.renderer().meshes().set_part(picture.meshes.back().mesh, 0, patch);
        picture.bounds.add(bounds_of(patch));
    }
    DrawnView drawn{{glm::lookAt(view.eye, view.target, view.up), Mat4(1.0), false}, 0, 0, width, height, Channel::all};
    const auto [near, far] = depth_range(drawn.projection.to_eye, picture.bounds);
    drawn.projection.to_clip = glm::perspective(view.vertical_field_of_view_rad,
                                                static_cast<double>(width) / static_cast<double>(height), near, far);
    return maker.draw(picture, {&drawn, 1});
}

}  // namespace tactus::display

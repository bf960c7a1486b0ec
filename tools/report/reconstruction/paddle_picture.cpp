// SPDX-License-Identifier: Apache-2.0
#include "tools/report/reconstruction/paddle_picture.hpp"

#include "devices/display/png.hpp"
#include "tools/render/flap_scene.hpp"

#include <glm/geometric.hpp>

#include <string>
#include <utility>
#include <vector>

namespace tactus::report {

namespace {

constexpr Vec3 kept_bone_colour{0.90, 0.86, 0.76};

}  // namespace

void write_paddle_picture(const analysis::FlapStudy& study, const analysis::PaddleStudy& found,
                          const std::filesystem::path& path) {
    std::vector<display::PictureMesh> meshes;
    for (const auto& [file, pose] : study.placed_files())
        meshes.push_back(render::picture_mesh(analysis::surface_of_piece(file), pose, {&kept_bone_colour, 1}));
    const skin::DrapedPaddle& draped = found.draped;
    meshes.push_back(
        render::picture_mesh(skin::shell_of(draped, found.settings.sheet.thickness), {}, {&paddle_colour, 1}));
    for (const skin::PaddleRope& rope : draped.ropes)
        meshes.push_back(render::tube_mesh({rope.bone, rope.skin}, 0.6e-3, render::flap_artery_colour));
    // Obliquely, so that the thickness and what is below can be seen.
    const Vec3 side = glm::normalize(draped.positions[1] - draped.positions[0]);
    const render::LabelledPicture picture = render::labelled_picture(
        meshes, -glm::normalize(draped.normal + 0.6 * glm::cross(draped.normal, side) + 0.3 * side), "skin paddle");
    display::write_png(picture.image, path.string());
}

}  // namespace tactus::report

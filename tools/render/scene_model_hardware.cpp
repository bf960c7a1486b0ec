// SPDX-License-Identifier: Apache-2.0
// Plates with their screws, implants and sites of a plan.
#include "assets/plan/case_plan.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/error.hpp"
#include "tools/render/flap_scene.hpp"
#include "tools/render/scene_colours.hpp"
#include "tools/render/scene_model.hpp"

namespace tactus::render {

namespace {

void append(geometry::SurfacePatch& patch, const display::PictureMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(patch.vertices.size());
    const auto vector = [](const std::vector<float>& all, std::size_t n) {
        return Vec3(static_cast<double>(all[3 * n]), static_cast<double>(all[3 * n + 1]),
                    static_cast<double>(all[3 * n + 2]));
    };
    for (std::size_t n = 0; n < mesh.positions.size() / 3; ++n)
        patch.vertices.push_back({{mesh.positions[3 * n], mesh.positions[3 * n + 1], mesh.positions[3 * n + 2]},
                                  geometry::packed_normal(vector(mesh.normals, n)),
                                  geometry::packed_colour(vector(mesh.colours, n), 1.0)});
    for (const std::uint32_t corner : mesh.triangles) patch.triangles.push_back(first + corner);
}

}  // namespace

void SceneModel::use_hardware(std::shared_ptr<const reconstruction::Reconstruction> of,
                              const std::filesystem::path& folder) {
    if (of == hardware_of_) return;
    hardware_of_ = std::move(of);
    for (const HardwareMesh& one : hardware_) renderer_.meshes().remove(one.mesh);
    hardware_.clear();
    if (!hardware_of_) return;
    const auto add = [&](const Hardware& one) -> HardwareMesh& {
        geometry::SurfacePatch patch;
        for (const display::PictureMesh& mesh : one.meshes) append(patch, mesh);
        HardwareMesh& made = hardware_.emplace_back();
        made.name = one.name;
        made.colour = one.colour;
        made.bounds = display::bounds_of(patch);
        made.mesh = renderer_.meshes().make();
        renderer_.meshes().set_part(made.mesh, 0, patch);
        return made;
    };
    for (const Hardware& one : render::hardware_of(hardware_of_->flap)) add(one);
    for (const Hardware& one : sites_of(hardware_of_->flap)) add(one).label = one.name;
    for (const reconstruction::KeptGuide& guide : hardware_of_->guides) {
        const Vec3 colour = scene_colours::guide_colour;
        try {
            const geometry::TriangleSurface surface =
                reconstruction::read_surface(plan::file_of(guide.mesh.file, folder));
            add({"guide " + guide.name, colour, {picture_mesh(surface, {}, {&colour, 1})}});
        } catch (const Error&) {
            // Its file was moved or removed: the plan can make it again.
        }
    }
}

void SceneModel::show_hardware() {
    for (const HardwareMesh& one : hardware_) {
        if (!is_part_shown(one.name, one.colour)) continue;
        part_of_mesh_.emplace_back(picture_.meshes.size(), one.name);
        show(one.mesh, {}, one.bounds);
        if (!one.label.empty()) labels_.push_back({one.label, 0.5 * (one.bounds.low + one.bounds.high), one.colour});
        if (is_chosen(one.name)) mark(one.bounds, {});
    }
}

}  // namespace tactus::render

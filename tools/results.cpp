// SPDX-License-Identifier: Apache-2.0
#include "tools/results.hpp"

#include "assets/bone/bone.hpp"
#include "assets/mesh/mesh.hpp"
#include "devices/display/offscreen.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

namespace tactus {

namespace {

// Dense bone white, porous bone green, as in the thesis that the saw trainer comes from.
const Vec3 cortex_colour{0.96, 0.94, 0.88}, core_colour{0.35, 0.68, 0.33};
constexpr double core_density = 500.0, cortex_density = 1500.0;  // kg/m³

/// Trilinear; positions outside count as the nearest inside.
double sample(const Grid& grid, const Vec3& position) {
    int cell[3];
    double share[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double last = grid.size[static_cast<std::size_t>(axis)] - 1;
        const double at = std::clamp((position[axis] - grid.origin[axis]) / grid.spacing[axis], 0.0, last);
        cell[axis] = static_cast<int>(std::min(at, last - 1.0));
        share[axis] = at - cell[axis];
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
        sum += (dx ? share[0] : 1 - share[0]) * (dy ? share[1] : 1 - share[1]) * (dz ? share[2] : 1 - share[2]) *
               static_cast<double>(grid.at(cell[0] + dx, cell[1] + dy, cell[2] + dz));
    }
    return sum;
}

PictureMesh coloured_surface(const Bone& bone) {
    const Mesh mesh = surface_of(bone.distance);
    PictureMesh picture;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3 &v = mesh.vertices[i], &n = mesh.normals[i];
        // A CT's partial-volume rim makes the surface of any bone look porous: the densest of what lies just below
        // it is what it is made of.
        double density = 0.0;
        for (int half_voxels = 1; half_voxels <= 6; ++half_voxels)
            density = std::max(density, sample(bone.density, v - n * (0.5 * half_voxels * bone.density.spacing.x)));
        const double t = std::clamp((density - core_density) / (cortex_density - core_density), 0.0, 1.0);
        const Vec3 colour = core_colour + (cortex_colour - core_colour) * t;
        for (int axis = 0; axis < 3; ++axis) {
            picture.positions.push_back(static_cast<float>(v[axis]));
            picture.normals.push_back(static_cast<float>(n[axis]));
            picture.colours.push_back(static_cast<float>(colour[axis]));
        }
    }
    for (const auto& triangle : mesh.triangles)
        for (const auto corner : triangle) picture.triangles.push_back(static_cast<std::uint32_t>(corner));
    return picture;
}

Vec3 vector_of(const Report& report, const char* key, const Vec3& otherwise) {
    const auto site = report.sections.find("site");
    if (site == report.sections.end() || !site->second.contains(key)) return otherwise;
    const auto* list = std::get_if<std::vector<double>>(&site->second.at(key));
    return list && list->size() == 3 ? Vec3((*list)[0], (*list)[1], (*list)[2]) : otherwise;
}

View view_of(const Report& report, const PictureMesh& mesh, double aspect) {
    Vec3 low(std::numeric_limits<double>::max()), high(-std::numeric_limits<double>::max());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto axis = static_cast<int>(i % 3);
        low[axis] = std::min(low[axis], static_cast<double>(mesh.positions[i]));
        high[axis] = std::max(high[axis], static_cast<double>(mesh.positions[i]));
    }
    const Vec3 normal = vector_of(report, "normal", Vec3(0.0, -1.0, 0.3));
    const Vec3 stroke = vector_of(report, "stroke", Vec3(1.0, 0.0, 0.0));
    // From before the cut and a little to its sides, so that the kerf shows its depth.
    const Vec3 across = glm::cross(normal, stroke);
    const Vec3 towards = glm::normalize(-normal - 0.55 * across - 0.45 * stroke);
    const Vec3 up = std::abs(towards.z) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, -1.0, 0.0);
    View view = fit_view(low, high, towards, up, aspect);
    // The box's corners are empty on anything but a box: go nearer.
    view.eye = view.target + (view.eye - view.target) * 0.8;
    return view;
}

}  // namespace

std::vector<std::string> write_pictures(const Report& report, const std::filesystem::path& folder) {
    constexpr int width = 1280, height = 800;
    std::vector<std::string> files;
    for (const auto& [name, result] : report.results) {
        const auto* bone = std::any_cast<std::shared_ptr<const Bone>>(&result);
        if (!bone) continue;
        const PictureMesh mesh = coloured_surface(**bone);
        if (mesh.triangles.empty()) continue;
        try {
            const View view = view_of(report, mesh, static_cast<double>(width) / height);
            write_png(render_picture(std::array{mesh}, view, width, height), (folder / (name + ".png")).string());
            files.push_back(name + ".png");
        } catch (const Error& error) {
            fmt::print(stderr, "tactus: no picture of the {}: {}\n", name, error.what());
        }
    }
    return files;
}

std::vector<std::string> write_bones(const Report& report, const std::filesystem::path& folder) {
    std::vector<std::string> files;
    for (const auto& [name, result] : report.results) {
        const auto* bone = std::any_cast<std::shared_ptr<const Bone>>(&result);
        if (!bone) continue;
        save_bone(**bone, folder / (name + ".vdb"));
        files.push_back(name + ".vdb");
    }
    return files;
}

}  // namespace tactus

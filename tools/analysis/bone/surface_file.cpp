// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/surface_file.hpp"

#include "assets/bone/surface_points.hpp"
#include "assets/file/extension.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/registration/vertex_points.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>

namespace tactus::analysis {

bool is_mesh(const std::filesystem::path& path) {
    const std::string extension = file::extension_of(path);
    return extension == ".stl" || extension == ".ply" || extension == ".obj";
}

namespace {

/// A mesh in m. One that states no unit is in mm.
mesh::Mesh mesh_of_file(const std::filesystem::path& path) {
    mesh::MeshOrigin origin;
    mesh::Mesh mesh = mesh::load_mesh(path, 1.0, &origin);
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& v : mesh.vertices) low = glm::min(low, v), high = glm::max(high, v);
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!origin.unit && !(extent >= 1.0 && extent <= 5000.0))
        throw Error(
            fmt::format("{}: the mesh states no unit and is {:.3g} units across, which is not plausible for a "
                        "bone in mm; convert it with 'tactus import --unit' and use the .vdb",
                        path.string(), extent));
    const double unit = origin.unit.value_or(1e-3);
    for (Vec3& v : mesh.vertices) v *= unit;
    return mesh;
}

}  // namespace

geometry::TriangleSurface surface_of_file(const std::filesystem::path& path, const volume::Grid& distance) {
    if (is_mesh(path)) return mesh_of_file(path);
    return mesh::export_surface(distance);
}

std::vector<contact::SurfacePoint> points_of_file(const std::filesystem::path& path, double spacing) {
    if (!is_mesh(path)) {
        return bone::surface_points(bone_of_file(path), {.spacing = spacing}, on_threads());
    }
    return fit::vertex_points(mesh_of_file(path));
}

double angle_deg(const Pose& pose) {
    return glm::length(rotation_between({1.0, 0.0, 0.0, 0.0}, pose.orientation)) * 180.0 / std::numbers::pi;
}

Vec3 middle_of(std::span<const contact::SurfacePoint> points) {
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
    return middle;
}

Motion motion_between(const Pose& from, const Pose& to, const Vec3& point) {
    return {glm::length(to.apply(point) - from.apply(point)), angle_deg(to * from.inverse())};
}

}  // namespace tactus::analysis

// SPDX-License-Identifier: Apache-2.0
// Surface points of bone files and meshes, and measures of motion.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <filesystem>
#include <span>
#include <vector>

namespace tactus::analysis {

/// True when a file is read as a mesh.
bool is_mesh(const std::filesystem::path& path);
/// The surface in the frame of the file, m: triangles of a mesh, or the zero surface of a bone's `distance`.
geometry::TriangleSurface surface_of_file(const std::filesystem::path& path, const volume::Grid& distance);
/// The vertices of a mesh, or the surface points of a bone; `spacing`, m: for a bone without points. Meshes need not be
/// closed. Throws Error.
std::vector<contact::SurfacePoint> points_of_file(const std::filesystem::path& path, double spacing = 0.5e-3);

/// Rotation angle of a pose, degrees.
double angle_deg(const Pose& pose);
/// Centroid of the points, m.
Vec3 middle_of(std::span<const contact::SurfacePoint> points);

/// Translation of a point, m, and rotation of its body, degrees.
struct Motion {
    double distance = 0.0, angle_deg = 0.0;
};
Motion motion_between(const Pose& from, const Pose& to, const Vec3& point);

}  // namespace tactus::analysis

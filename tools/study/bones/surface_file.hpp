// SPDX-License-Identifier: Apache-2.0
// Surfaces of bone files and meshes as points, and how far they move.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <filesystem>
#include <span>
#include <vector>

namespace tactus::study {

/// Whether a file is read as triangles.
bool is_mesh(const std::filesystem::path& path);
/// The surface in the frame of its file, m: a mesh's own triangles, or that of a bone's distance.
geometry::TriangleSurface surface_of_file(const std::filesystem::path& path, const bone::Bone& bone);
/// The points of a mesh's corners, or of a bone. Meshes need not be closed. Throws Error.
std::vector<contact::SurfacePoint> points_of_file(const std::filesystem::path& path);

/// Angle of a pose from none, degrees.
double angle_deg(const Pose& pose);
/// Middle of the points, m.
Vec3 middle_of(std::span<const contact::SurfacePoint> points);

/// How far a point moves, m, and how far its body turns, degrees.
struct Motion {
    double distance = 0.0, angle_deg = 0.0;
};
Motion motion_between(const Pose& from, const Pose& to, const Vec3& point);

}  // namespace tactus::study

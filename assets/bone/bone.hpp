// SPDX-License-Identifier: Apache-2.0
// Bones: a signed distance and a density on one grid, with their provenance; and files of one or several bones.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/scanned_border.hpp"
#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace tactus::bone {

/// A bone ready for contact, carving and images. Both grids have the same size, origin and spacing.
struct Bone {
    volume::Grid distance;  ///< signed distance to the surface, m, negative inside; frame LPS, metres
    volume::Grid density;  ///< mass density, kg/m³, ≥ 0
    std::string name;  ///< shown to users, e.g. "mandible"
    Vec3 colour{0.90, 0.86, 0.76};  ///< sRGB, 0 to 1; default colour in images

    /// Provenance as text: source, hash, options, calibration, frame ("LPS"), hu ("calibrated", "masked", ...).
    std::map<std::string, std::string> provenance;

    /// Surface points for contact, with outward normals, areas and labels, in the frame of the grids. May be empty.
    std::vector<contact::SurfacePoint> points;

    /// The border with other labels in the scan, in the frame of the grids. See surface_points.hpp.
    contact::ScannedBorder border;
};

/// Writes one OpenVDB file. A single bone's float grids are called "distance" and "density", those of several
/// "NAME.distance" and "NAME.density"; colour, provenance, surface points and scanned border are metadata of the distance
/// grid. All bones of a file share one frame; their grids may differ. The same bones give the same bytes. A checksum
/// follows the OpenVDB data; other programs ignore it. The file is written atomically. Throws Error if a bone's grids
/// do not match, if two bones have the same name, if there are no bones, or if the file cannot be written.
void save_bones(std::span<const Bone> bones, const std::filesystem::path& path);
void save_bone(const Bone& bone, const std::filesystem::path& path);

/// Reads a file of save_bones: the same bits in the same order. Grids of other types are ignored. Throws Error for a
/// file that is damaged, was written by another program or has a later format, before it allocates the memory stated in
/// the header.
std::vector<Bone> load_bones(const std::filesystem::path& path);

/// Loads the only bone of a file, or the bone that "FILE.vdb#NAME" names. Throws Error as load_bones does; for a
/// missing or unknown name the message lists the names.
Bone load_bone(const std::filesystem::path& path);

/// The path without "#NAME", unless a file of the full name exists.
std::filesystem::path file_of_bone(const std::filesystem::path& path);

/// Returns whether two paths, either of which may have a "#NAME", name the same bone of the same file.
bool name_one_bone(const std::filesystem::path& one, const std::filesystem::path& other);

}  // namespace tactus::bone

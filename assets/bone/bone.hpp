// SPDX-License-Identifier: Apache-2.0
// What a bone is: a signed distance and a density on one grid, and where they came from; files of one or several bones.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace tactus::bone {

/// A bone ready for contact, carving and pictures. Both grids have the same size, origin and spacing.
struct Bone {
    volume::Grid distance;  ///< signed distance to the surface, m, negative inside; frame LPS, metres
    volume::Grid density;  ///< mass density, kg/m³, ≥ 0
    std::string name;  ///< what people call it, e.g. "mandible"
    Vec3 colour{0.90, 0.86, 0.76};  ///< sRGB, 0 to 1; what it is drawn in where nothing else decides

    /// Where it came from, as text: source, hash, options, calibration, frame ("LPS"), hu ("calibrated", "masked", ...).
    std::map<std::string, std::string> provenance;

    /// Points of its surface for contact, with outward normals, areas and labels; often none. Frame as the grids'.
    std::vector<contact::SurfacePoint> points;
};

/// Writes one OpenVDB file. A single bone's float grids are called "distance" and "density", those of several
/// "NAME.distance" and "NAME.density"; colour, provenance and surface points are metadata of the distance grid. All bones of a file
/// share one frame; their grids may differ. The same bones give the same bytes. A checksum follows the OpenVDB data;
/// other programs do not read that far. The file appears whole or not at all. Throws Error when a bone's grids do not
/// match, when two bones have the same name, when there is none, or when the file cannot be written.
void save_bones(std::span<const Bone> bones, const std::filesystem::path& path);
void save_bone(const Bone& bone, const std::filesystem::path& path);

/// Reads what save_bones wrote, every bit as it was, in the same order. Grids of other kinds are passed over. Throws
/// Error for anything that is damaged, of another making or of a later format, before memory is taken for what its
/// header claims.
std::vector<Bone> load_bones(const std::filesystem::path& path);

/// The only bone of a file, or of several the one that "FILE.vdb#NAME" names. Throws Error as load_bones does, and for
/// a name that is missing or not in the file, listing those that are.
Bone load_bone(const std::filesystem::path& path);

/// The file of "FILE.vdb#NAME": without the name, unless a file is really called so.
std::filesystem::path file_of_bone(const std::filesystem::path& path);

}  // namespace tactus::bone

// SPDX-License-Identifier: Apache-2.0
// What a bone is: a signed distance and a density on one grid, and where they came from.
#pragma once

#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace tactus {

/// A bone ready for contact, carving and pictures. Both grids have the same size, origin and spacing.
struct Bone {
    Grid distance;     ///< signed distance to the surface, m, negative inside; frame LPS, metres
    Grid density;      ///< mass density, kg/m³, ≥ 0
    std::string name;  ///< what people call it, e.g. "mandible"

    /// Where it came from, as text: source, hash, options, calibration, frame ("LPS"), hu ("HU", "masked", ...).
    std::map<std::string, std::string> provenance;
};

/// Writes one OpenVDB file with the float grids "distance" and "density" and the provenance as metadata. The same bone
/// gives the same bytes. A checksum follows the OpenVDB data; other programs do not read that far. The file appears
/// whole or not at all. Throws Error when the grids do not match or the file cannot be written.
void save_bone(const Bone& bone, const std::filesystem::path& path);

/// Reads a file written by save_bone, every bit as it was. Throws Error for anything that is damaged or of another
/// making, before memory is taken for what its header claims.
Bone load_bone(const std::filesystem::path& path);

}  // namespace tactus

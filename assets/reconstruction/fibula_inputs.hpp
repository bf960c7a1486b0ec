// SPDX-License-Identifier: Apache-2.0
// Reads the inputs of a fibula free flap plan from a file.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::reconstruction {

inline constexpr double farthest_mm = 1e5;  // maximum magnitude of a coordinate in a file
inline constexpr std::size_t max_planes = 6;

/// Reads
///     {"units": "mm", "mandible_planes": [{"name": "left", "origin": [x, y, z], "normal": [...], "y": [...]}, ...],
///      "fibula_line": {"point": [...], "direction": [...]}, "leg": "left", "between_space_mm": 1.5,
///      "distal_margin_mm": 75, "proximal_margin_mm": 60, "along_line_mm": [...], "roll_deg": 0, "reversed": false,
///      "kerf_mm": 0.4, "resection": "between", "donor": "fibula.stl", "jaw": "jaw.stl"}
/// in LPS. Instead of the planes the file may contain a curve along the jaw, "jaw_curve": [[x, y, z], ...] with
/// "segments": 3 and optionally "least_segment_mm": 20. All members from "leg" on are optional, and so are normals of
/// inner planes and each "y". The members of the flap (read_reconstruction_inputs), "x" of planes, "source"
/// and "notes" are accepted and ignored; "frame" must begin with "LPS"; others are rejected. Paths of meshes are relative to the file; their unit is
/// mm unless they state another. Throws Error.
FibulaInputs read_fibula_inputs(const std::filesystem::path& path);

/// The same from the text of a file. It does not load the donor and the jaw, but returns their paths (empty: none).
/// `file` is the name in messages.
FibulaInputs fibula_inputs_of_text(std::string_view text, const std::string& file, std::string* donor = nullptr,
                                   std::string* jaw = nullptr);

}  // namespace tactus::reconstruction

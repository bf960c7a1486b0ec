// SPDX-License-Identifier: Apache-2.0
// What is planned for a fibula free flap, in a file.
#pragma once

#include "dsp/reconstruct/fibula_plan.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::reconstruct {

inline constexpr double farthest_mm = 1e5;  // of a coordinate in a file
inline constexpr std::size_t most_planes = 6;

/// Reads
///     {"units": "mm", "mandible_planes": [{"name": "left", "origin": [x, y, z], "normal": [...], "y": [...]}, ...],
///      "fibula_line": {"point": [...], "direction": [...]}, "leg": "left", "between_space_mm": 1.5,
///      "distal_margin_mm": 75, "proximal_margin_mm": 60, "along_line_mm": [...], "roll_deg": 0, "reversed": false,
///      "kerf_mm": 0.4, "resection": "between", "donor": "fibula.stl", "jaw": "jaw.stl"}
/// in LPS; in place of the planes a curve along the jaw, "jaw_curve": [[x, y, z], ...] with "segments": 3 and, if wanted,
/// "least_segment_mm": 20. All from "leg" on may be missing, as may normals of inner planes and each "y". The members of the
/// flap (read_reconstruction_inputs), "x" of planes, "frame", "source" and "notes" are accepted and not read; others are
/// refused. Paths of meshes are relative to the file; their unit is mm unless they state another. Throws Error.
FibulaInputs read_fibula_inputs(const std::filesystem::path& path);

/// The same from the text of a file, without the donor and the jaw, whose paths are returned (empty: none); `file` is the
/// name in messages.
FibulaInputs fibula_inputs_of_text(std::string_view text, const std::string& file, std::string* donor = nullptr,
                                   std::string* jaw = nullptr);

}  // namespace tactus::reconstruct

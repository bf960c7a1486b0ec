// SPDX-License-Identifier: Apache-2.0
// Writes volumes in formats of other programs.
#pragma once

#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <string>

namespace tactus::volume {

/// Storage type of the samples.
enum class WrittenType { int16, float32 };

/// Writes a grid (LPS, m) as NRRD (.nrrd: LPS, mm, gzip) or NIfTI-1 (.nii, .nii.gz: RAS, mm; the order of the samples
/// is kept, and the header states their directions). int16 values are rounded and clamped. Written atomically. Throws
/// Error for other extensions, for more than 32767 samples along an axis of a NIfTI file, and when the file cannot be
/// written.
void write_volume(const Grid& grid, WrittenType type, const std::filesystem::path& path);

}  // namespace tactus::volume

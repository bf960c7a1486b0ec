// SPDX-License-Identifier: Apache-2.0
// Volumes to files that other programs read.
#pragma once

#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <string>

namespace tactus::volume {

/// How samples are stored.
enum class WrittenType { int16, float32 };

/// Writes a grid (LPS, m) as NRRD (.nrrd: LPS, mm, gzip) or NIfTI-1 (.nii, .nii.gz: RAS, mm; the samples stay in their
/// order, the header says which way they run). For int16 values are rounded and clamped. Throws Error for other
/// extensions, for more than 32767 samples along an axis of a NIfTI file, and when the file cannot be written; it appears
/// whole or not at all.
void write_volume(const Grid& grid, WrittenType type, const std::filesystem::path& path);

}  // namespace tactus::volume

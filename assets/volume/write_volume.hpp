// SPDX-License-Identifier: Apache-2.0
// Writes volumes in formats of other programs.
#pragma once

#include "assets/volume/scan_volume.hpp"
#include "dsp/volume/grid.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace tactus::volume {

/// Storage type of the samples.
enum class WrittenType { int16, float32 };

/// Writes a grid (LPS, m) as NRRD (.nrrd: LPS, mm, gzip) or NIfTI-1 (.nii, .nii.gz: RAS, mm; the order of the samples
/// is kept, and the header states their directions). int16 values are rounded and clamped. `surface_hu`: written under
/// surface_hu_key. Written atomically. Throws Error for other extensions, for more than 32767 samples along an axis of
/// a NIfTI file, and when the file cannot be written.
void write_volume(const Grid& grid, WrittenType type, const std::filesystem::path& path,
                  std::optional<double> surface_hu = {});

/// Writes a label map as NRRD (.nrrd: LPS, mm, gzip, one byte per sample), with names and colours of its segments as
/// 3D Slicer stores them, so that it reads a file .seg.nrrd as a segmentation. `layout`: size, origin and spacing; its
/// values are not read. A segment without colour is written without one. Written atomically. Throws Error for other
/// extensions, for a name with a line break, and when the file cannot be written.
void write_labels(const Grid& layout, std::span<const std::uint8_t> labels, std::span<const Segment> segments,
                  const std::filesystem::path& path);

}  // namespace tactus::volume

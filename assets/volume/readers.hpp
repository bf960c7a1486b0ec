// SPDX-License-Identifier: Apache-2.0
// The readers of read_volume, one per format, and their common checks.
#pragma once

#include "assets/volume/scan_volume.hpp"
#include "assets/volume/slice_reader.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::volume {

std::unique_ptr<SliceReader> open_nrrd(const std::filesystem::path& path);
std::unique_ptr<SliceReader> open_nifti(const std::filesystem::path& path);
std::unique_ptr<SliceReader> open_inv3(const std::filesystem::path& path);
/// A file, or a folder with its files.
std::unique_ptr<SliceReader> open_dicom(const std::filesystem::path& path, const ReadOptions& options);
/// Detects the DICM mark after the preamble.
bool is_dicom_file(const std::filesystem::path& path);
/// The files that are read of a folder and those in it, ascending. Throws Error when there are too many.
std::vector<std::filesystem::path> dicom_files_in(const std::filesystem::path& folder);

/// The value of surface_hu_key. None if the text is not a finite number.
std::optional<double> parse_surface_hu(std::string_view text);

/// Number of samples. Throws Error when an axis is empty or there are more than 1e9 samples.
std::size_t checked_count(const std::array<std::int64_t, 3>& size, const std::string& file);
/// Throws Error unless every spacing is between 0.00001 and 100 mm and the axes span a volume. The lower limit lets files
/// in m pass, whose unit is asked for later.
void check_map(const SampleMap<Frame::lps>& map, const std::string& file);
/// Throws Error when a value is not a number. Derives kind and hu from the values when the file does not state them.
/// Labels: whole numbers from 0 to 255, most of them 0, if the samples were `integers`. Calibrated HU: air near -1000.
/// Masked: zeros at the border and in most voxels. Everything else: uncalibrated scanner values.
void settle_meaning(ScanVolume& volume, const Tally& tally, bool integers);

}  // namespace tactus::volume

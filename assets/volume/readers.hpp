// SPDX-License-Identifier: Apache-2.0
// The readers behind read_volume, one per format, and the checks they share.
#pragma once

#include "assets/volume/scan_volume.hpp"
#include "assets/volume/slice_reader.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tactus::volume {

std::unique_ptr<SliceReader> open_nrrd(const std::filesystem::path& path);
std::unique_ptr<SliceReader> open_nifti(const std::filesystem::path& path);
std::unique_ptr<SliceReader> open_inv3(const std::filesystem::path& path);
/// One file, or a folder and what lies in it.
std::unique_ptr<SliceReader> open_dicom(const std::filesystem::path& path, const ReadOptions& options);
/// By the mark behind the preamble.
bool is_dicom_file(const std::filesystem::path& path);

/// Number of samples. Throws Error when an axis is empty or there are more than 1e9 samples.
std::size_t checked_count(const std::array<std::int64_t, 3>& size, const std::string& file);
/// Throws Error unless every spacing is between 0.001 and 100 mm and the axes span a volume.
void check_map(const SampleMap<Frame::lps>& map, const std::string& file);
/// Throws Error when a value is not a number. Sets kind and hu from the values where the file did not say: whole
/// numbers from 0 to 255, most of them 0, are labels if the samples were `integers`. What else numbers can be: air near
/// -1000 shows HU; a masked volume has zeros all around and in most places; all else is scanner numbers.
void settle_meaning(ScanVolume& volume, const Tally& tally, bool integers);

}  // namespace tactus::volume

// SPDX-License-Identifier: Apache-2.0
// The same volume written in each format, byte by byte, so that readers are not tested with their own libraries.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus {

/// Samples of HU and where they lie: LPS, mm.
struct WrittenVolume {
    std::array<int, 3> size{0, 0, 0};
    Mat3 step{1.0};
    Vec3 origin{0.0};
    std::vector<std::int16_t> hu;

    Vec3 position(int i, int j, int k) const { return origin + step * Vec3(i, j, k); }
    /// Samples a density given over mm.
    void fill(const std::function<double(const Vec3&)>& density);
};

std::string nrrd_bytes(const WrittenVolume& volume);
/// NIfTI-1 (or -2) in RAS, by sform or by quaternion (then axes must be square), in either byte order.
struct NiftiStyle {
    bool second = false, swapped = false, quaternion = false;
};
std::string nifti_bytes(const WrittenVolume& volume, const NiftiStyle& style = {});
/// An archive without gzip around it; mirrored rows, as InVesalius has them.
std::string inv3_tar(const WrittenVolume& volume);

/// What varies between DICOM files of a slice.
struct SliceStyle {
    std::string series = "1.2.3.4", instance, image_type = "ORIGINAL\\PRIMARY\\AXIAL", photometric = "MONOCHROME2";
    std::string rescale_type = "HU";
    double intercept = -1024.0, slope = 1.0;
    Vec3 shift{0.0};  // mm, of the position that is stated
};
std::string dicom_bytes(const WrittenVolume& volume, int slice, const SliceStyle& style = {});
/// All slices as frames of one enhanced file.
std::string enhanced_dicom_bytes(const WrittenVolume& volume);
/// One file per slice, written in an order that is not theirs.
void write_dicom_folder(const WrittenVolume& volume, const std::filesystem::path& folder, const SliceStyle& style = {});

}  // namespace tactus

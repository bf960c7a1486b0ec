// SPDX-License-Identifier: Apache-2.0
// CT volumes from NRRD files.
#pragma once

#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <string>

namespace tactus {

struct CtVolume {
    Grid grid;             ///< LPS, m; values as in the file
    bool resampled;        ///< the file's axes were turned against LPS, so values were interpolated
    bool is_signed;        ///< the file's samples can be negative
    std::string encoding;  ///< "raw", "gzip", ...
};

/// Reads a scalar three-dimensional NRRD (attached or detached header, any sample type and byte order, the encodings
/// that teem knows) whose space is LPS, RAS or LAS in mm. Mirrored and permuted axes are sorted, turned ones resampled
/// to the smallest spacing. Throws Error for sheared axes, a missing or unknown geometry, and for files that are shorter than
/// their header says, before memory is taken for it.
CtVolume load_nrrd(const std::filesystem::path& path);

}  // namespace tactus

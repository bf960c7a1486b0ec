// SPDX-License-Identifier: Apache-2.0
// DICOM files whose samples are compressed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::campaign {

/// Writes `to` with the samples of `from` compressed; `kind`: rle, jpeg, jpeg_ls, j2k or j2k_lossy. Throws when GDCM
/// cannot.
void pack_dicom(const std::filesystem::path& from, const std::filesystem::path& to, const std::string& kind);

/// Writes a slice and a file of frames to `folder`, each compressed by run lengths, JPEG, JPEG-LS and JPEG 2000. Throws
/// when GDCM cannot.
std::vector<std::filesystem::path> packed_dicom(const std::filesystem::path& folder);

}  // namespace tactus::campaign

// SPDX-License-Identifier: Apache-2.0
// DICOM files whose samples are compressed.
#pragma once

#include <filesystem>
#include <vector>

namespace tactus::campaign {

/// Writes a slice and a file of frames to `folder`, each compressed by run lengths, JPEG, JPEG-LS and JPEG 2000. Throws
/// when GDCM cannot.
std::vector<std::filesystem::path> packed_dicom(const std::filesystem::path& folder);

}  // namespace tactus::campaign

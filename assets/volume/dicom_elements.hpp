// SPDX-License-Identifier: Apache-2.0
// Checks the structure of a DICOM file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::volume {

/// Walks all elements, sequences and items of a file with the DICM mark. Throws Error when one does not lie within the
/// file or its container. GDCM aborts the program on some of these errors, so it only gets files that pass.
void check_dicom_elements(const std::filesystem::path& path);
/// The same for the bytes of a file; `file` names it in messages.
void check_dicom_elements(std::string_view bytes, const std::string& file);

}  // namespace tactus::volume

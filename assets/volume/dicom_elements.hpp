// SPDX-License-Identifier: Apache-2.0
// The bare structure of a DICOM file.
#pragma once

#include <filesystem>

namespace tactus::volume {

/// Walks over all elements, sequences and items of a file with the DICM mark. Throws Error when one does not lie within
/// the file or within what holds it. GDCM ends the program at some of these, so it only gets files that pass.
void check_dicom_elements(const std::filesystem::path& path);

}  // namespace tactus::volume

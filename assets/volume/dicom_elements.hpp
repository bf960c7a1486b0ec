// SPDX-License-Identifier: Apache-2.0
// The structure of a DICOM file.
#pragma once

#include <string>
#include <string_view>

namespace tactus::volume {

/// Walks all elements, sequences and items of a file and reports what it does not understand, with its place; empty: the
/// whole file. This is no reason to refuse a file that the library reads: it explains why one cannot be read. Throws
/// Error when the samples themselves reach beyond the end of the file, which no library can repair. `file` names it.
std::string doubt_about_dicom(std::string_view bytes, const std::string& file);

}  // namespace tactus::volume

// SPDX-License-Identifier: Apache-2.0
// teem copies what it finds in a header into buffers of fixed size when it complains about it.
#pragma once

#include <filesystem>

namespace tactus::volume {

/// Throws Error unless the file begins with an NRRD header that teem can be given: at most 10 000 lines and 16 MB in
/// all, and no field longer than 700 bytes. Comments, key/value pairs and 'content', which teem copies into memory of
/// their size, may be longer.
void check_nrrd_header(const std::filesystem::path& path);

}  // namespace tactus::volume

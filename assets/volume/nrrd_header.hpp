// SPDX-License-Identifier: Apache-2.0
// Guards teem: its error messages copy header fields into buffers of fixed size.
#pragma once

#include <filesystem>

namespace tactus::volume {

/// Throws Error unless the file starts with an NRRD header within the limits: 10 000 lines, 16 MB in all, and 700 bytes
/// per field. Comments, key/value pairs and 'content' may be longer, because teem allocates memory for them.
void check_nrrd_header(const std::filesystem::path& path);

}  // namespace tactus::volume

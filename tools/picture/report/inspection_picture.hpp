// SPDX-License-Identifier: Apache-2.0
// A picture of what is in a file.
#pragma once

#include "tools/study/bones/inspection.hpp"

#include <filesystem>

namespace tactus::picture {

/// Three slices through the largest part and a view of the surface, PNG; a mesh: three sides and a view. Throws Error.
void write_picture(const study::Inspection& inspection, const std::filesystem::path& path);

}  // namespace tactus::picture

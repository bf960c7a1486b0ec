// SPDX-License-Identifier: Apache-2.0
// A picture of the content of a file.
#pragma once

#include "tools/analysis/bone/inspection.hpp"

#include <filesystem>

namespace tactus::report {

/// Writes a PNG: three slices through the largest part and a view of the surface; for a mesh three sides and a view.
/// Painted fractures are red; they add two more views.
/// Throws Error.
void write_picture(const analysis::Inspection& inspection, const std::filesystem::path& path);

}  // namespace tactus::report

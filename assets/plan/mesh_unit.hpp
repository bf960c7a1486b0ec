// SPDX-License-Identifier: Apache-2.0
// Default unit of a plan's files, which usually state none.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::plan {

/// Returns "mm", or nothing if a mesh states its unit or has an implausible size for mm; then the import decides or
/// rejects the file.
std::optional<std::string> unit_of_file(const std::filesystem::path& path);

}  // namespace tactus::plan

// SPDX-License-Identifier: Apache-2.0
// The unit of a plan's files, which state none.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tactus::cases {

/// "mm", unless a mesh states its unit or is far too small or too large for that: none, and import decides or refuses.
std::optional<std::string> unit_of_file(const std::filesystem::path& path);

}  // namespace tactus::cases

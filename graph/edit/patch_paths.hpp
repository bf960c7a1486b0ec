// SPDX-License-Identifier: Apache-2.0
// Moves a patch's text to another folder: its relative paths are changed so that they name the same files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::edit {

/// The text with the relative paths of [assets] and of `type = "patch:..."` made absolute, as seen from `folder`, which
/// is absolute. All other bytes stay.
std::string with_absolute_paths(std::string_view text, const std::filesystem::path& folder);

}  // namespace tactus::edit

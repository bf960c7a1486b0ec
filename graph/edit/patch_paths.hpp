// SPDX-License-Identifier: Apache-2.0
// Moves a patch's text to another folder: its relative paths are changed so that they name the same files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::edit {

/// The text for another folder, both absolute: what lies below `to` is named from there, all else by absolute paths.
/// In the same folder nothing changes. All other bytes stay.
std::string with_paths_moved(std::string_view text, const std::filesystem::path& from, const std::filesystem::path& to);

/// A file as a patch in `folder` names it: by a relative path when it lies below, else by its absolute one.
std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The text with the relative paths of [assets] and of `type = "patch:..."` made absolute, as seen from `folder`, which
/// is absolute. All other bytes stay.
std::string with_absolute_paths(std::string_view text, const std::filesystem::path& folder);

}  // namespace tactus::edit

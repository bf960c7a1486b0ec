// SPDX-License-Identifier: Apache-2.0
// Moves a patch's text to another folder: relative paths are rewritten so that they name the same files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::edit {

/// Returns the text for another folder; both folders are absolute. Files below `to` get relative paths, all others
/// absolute ones. Within the same folder nothing changes. All other bytes stay unchanged.
std::string with_paths_moved(std::string_view text, const std::filesystem::path& from, const std::filesystem::path& to);

/// The path of a file for a patch in `folder`: relative if the file lies below the folder, otherwise absolute.
std::string path_from(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The text with the relative paths of [assets] and of `type = "patch:..."` made absolute, as seen from `folder`, which
/// is absolute. All other bytes stay unchanged.
std::string with_absolute_paths(std::string_view text, const std::filesystem::path& folder);

}  // namespace tactus::edit

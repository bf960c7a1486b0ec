// SPDX-License-Identifier: Apache-2.0
// A patch's text that moves to another folder: the files that it names by relative paths are still those it named.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::edit {

/// The text with the relative paths of [assets] and of `type = "patch:..."` made absolute, as seen from `folder`, which
/// is absolute. All other bytes stay.
std::string with_absolute_paths(std::string_view text, const std::filesystem::path& folder);

}  // namespace tactus::edit

// SPDX-License-Identifier: Apache-2.0
// Edits of a patch that were not saved when their window went: kept in a file, and found again by the next window.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace tactus::view {

/// Writes `text` durably to `NAME.unsaved.toml` beside the patch, or, where that cannot be written and for patches of the
/// library, to `$XDG_STATE_HOME/tactus/unsaved` (default `~/.local/state`). A file that is there stays; the new one is
/// numbered. Returns where it is. Throws Error when it can be written nowhere.
std::filesystem::path keep_unsaved(const std::filesystem::path& patch, std::string_view text);

/// What was kept of that patch, the newest last.
std::vector<std::filesystem::path> find_unsaved(const std::filesystem::path& patch);

}  // namespace tactus::view

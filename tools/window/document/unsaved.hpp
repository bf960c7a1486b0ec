// SPDX-License-Identifier: Apache-2.0
// Keeps unsaved edits of a patch or a plan in a file, and finds them for the next window.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace tactus::window {

/// Writes `text` durably to `NAME.unsaved.toml` (of a plan: `.json`) beside the patch, or, where that cannot be written and for patches of
/// the library, to `$XDG_STATE_HOME/tactus/unsaved` (default `~/.local/state`). An existing file is kept; the new one
/// gets a number. Returns the path. Throws Error when no place is writable.
std::filesystem::path keep_unsaved(const std::filesystem::path& patch, std::string_view text);

/// Files with kept edits of that patch, newest last.
std::vector<std::filesystem::path> find_unsaved(const std::filesystem::path& patch);

}  // namespace tactus::window

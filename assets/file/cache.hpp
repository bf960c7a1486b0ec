// SPDX-License-Identifier: Apache-2.0
// The user's cache folder: files that can be made again from other files, so that any of them may be removed at any time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace tactus::file {

/// $XDG_CACHE_HOME/tactus, otherwise ~/.cache/tactus. Empty when neither is an absolute path.
std::filesystem::path root_of_cache();

/// The same; empty when the limit is 0, too: nothing is kept, and nothing that was kept is read.
std::filesystem::path cache_folder();

/// Bytes that the folder may hold: TACTUS_CACHE_LIMIT (MB), by default 4,000 MB. 0 turns the cache off. Throws Error
/// for anything else than a whole number.
std::uintmax_t cache_limit();

/// Writes a file of the cache, readable by its owner only (it is derived from data of patients), and removes the files
/// that were unused for longest until the folder is within its limit. The file is complete or does not exist; nothing
/// is written when there is no room, no permission, or when another process is writing it.
void write_cached(const std::filesystem::path& path, std::string_view bytes) noexcept;

/// Marks a file as used now.
void touch_cached(const std::filesystem::path& path) noexcept;

/// A checksum for the heads of cached files: 16 hexadecimal digits.
std::string checksum(std::string_view bytes);

/// What is in the cache.
struct CacheContent {
    std::size_t files = 0;
    std::uintmax_t bytes = 0;
};
CacheContent cache_content();

/// Removes all files of the cache, and returns what was removed. Files that other processes are writing stay. Throws
/// Error when a file cannot be removed.
CacheContent clear_cache();

}  // namespace tactus::file

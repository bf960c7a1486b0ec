// SPDX-License-Identifier: Apache-2.0
// The user's cache folder: files that can be recomputed from other files, so that any of them may be removed at any
// time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace tactus::file {

/// Returns $XDG_CACHE_HOME/tactus, otherwise ~/.cache/tactus. Empty if neither is an absolute path.
std::filesystem::path root_of_cache();

/// The same, but also empty if the limit is 0: then nothing is cached and the cache is not read.
std::filesystem::path cache_folder();

/// Returns the maximum size of the folder in bytes: TACTUS_CACHE_LIMIT (MB), by default 4,000 MB. 0 disables the cache.
/// Throws Error if it is not an integer.
std::uintmax_t cache_limit();

/// Writes a file of the cache, readable only by its owner (it is derived from patient data), and removes the least
/// recently used files until the folder is within its limit. The file is complete or does not exist; nothing is written
/// without disk space or permission, or while another process is writing the file.
void write_cached(const std::filesystem::path& path, std::string_view bytes) noexcept;

/// Updates the time of last use of a file.
void touch_cached(const std::filesystem::path& path) noexcept;

/// Returns a checksum for the header of cached files: 16 hexadecimal digits.
std::string checksum(std::string_view bytes);

/// Content of the cache.
struct CacheContent {
    std::size_t files = 0;
    std::uintmax_t bytes = 0;
};
CacheContent cache_content();

/// Removes all files of the cache, and returns their number and size. Files that other processes are writing are not
/// removed. Throws Error if a file cannot be removed.
CacheContent clear_cache();

}  // namespace tactus::file

// SPDX-License-Identifier: Apache-2.0
// Whole files as bytes: read at once, hashed in blocks, written beside and renamed.
#pragma once

#include "dsp/core/hash.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::file {

/// Every reader asks this before it opens a file: a pipe or a device would make it wait, or never end. Throws Error
/// unless `path` is a regular file; gives its size in bytes.
std::uintmax_t require_file(const std::filesystem::path& path);

/// All bytes of a regular file. Throws Error.
std::string read_whole_file(const std::filesystem::path& path);

/// Adds the bytes of a file of any size to `hash`, as one add_bytes would. Throws Error.
void add_file(Hash& hash, const std::filesystem::path& path);

/// Writes `bytes` to `path` + ".part" and renames it. On failure nothing is left behind and Error is thrown.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

/// The same, and the disk has both the bytes and the name before it returns: after a power failure the old file or the
/// new one is there.
void write_durable_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace tactus::file

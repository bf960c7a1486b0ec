// SPDX-License-Identifier: Apache-2.0
// Whole files as bytes: read, hash, and write atomically (temporary file, then rename).
#pragma once

#include "dsp/core/hash.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::file {

/// Size of a regular file in bytes. Throws Error for anything else: reading a pipe or a device could block or never
/// end. Every reader calls this before it opens a file.
std::uintmax_t require_file(const std::filesystem::path& path);

/// All bytes of a regular file. Throws Error.
std::string read_whole_file(const std::filesystem::path& path);

/// Adds the bytes of a file to `hash`, in blocks. Throws Error.
void add_file(Hash& hash, const std::filesystem::path& path);

/// Writes `bytes` to `path` + ".part" and renames it; a replaced file keeps its permissions. On failure it removes the
/// part and throws Error.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

/// The same, synced to disk: after a power failure the old or the new file exists.
void write_durable_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace tactus::file

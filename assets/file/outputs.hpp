// SPDX-License-Identifier: Apache-2.0
// Checks the names of output files before the work starts.
#pragma once

#include <filesystem>
#include <span>

namespace tactus::file {

/// Whether the file `out` exists and is the source, lies in it (a folder), or is named by it (TOML or JSON: a patch, a
/// plan, a task), also through other files.
bool is_of_source(const std::filesystem::path& source, const std::filesystem::path& out);

/// Whether a path is a stream, such as /dev/stdout or a pipe: output is written into it, under any ending.
bool is_stream(const std::filesystem::path& out);

/// Throws Error if an output belongs to one of the sources (see is_of_source), occurs twice in the list, is a folder, or
/// has no folder or one that may not be written to. Empty paths are skipped. Called first, because a result must never
/// overwrite a patient's scan or another result.
void check_outputs(std::span<const std::filesystem::path> sources, std::span<const std::filesystem::path> outputs);

}  // namespace tactus::file

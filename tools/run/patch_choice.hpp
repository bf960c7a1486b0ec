// SPDX-License-Identifier: Apache-2.0
// A patch with overrides, as given on the command line.
#pragma once

#include "graph/patch/patch.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace tactus::run {

struct PatchChoice {
    std::string patch;  ///< a path, or a name in the library
    std::optional<std::string> text;  ///< replaces the content of the file, which need not exist
    patch::PatchOverrides overrides;
    std::optional<std::uint64_t> seed;
};

/// Reads the given text or file. Problems are collected. Throws Error if it cannot be read.
patch::Patch read_choice(const PatchChoice& choice, patch::Problems& problems);
/// Path of the patch, even if the file does not exist. Throws Error like find_patch().
std::filesystem::path file_of(const PatchChoice& choice);

}  // namespace tactus::run

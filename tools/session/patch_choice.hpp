// SPDX-License-Identifier: Apache-2.0
// A patch with overrides, as given on the command line.
#pragma once

#include "graph/patch/patch.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace tactus::session {

struct PatchChoice {
    std::string patch;  ///< a path, or a name in the library
    std::optional<std::string> text;  ///< used in place of what the file holds; the file need not be there
    patch::PatchOverrides overrides;
    std::optional<std::uint64_t> seed;
};

/// The patch as given: its text, or the file's. Problems are collected. Throws Error when it cannot be read.
patch::Patch read_choice(const PatchChoice& choice, patch::Problems& problems);
/// Where the patch is, or would be. Throws Error like find_patch().
std::filesystem::path file_of(const PatchChoice& choice);

}  // namespace tactus::session

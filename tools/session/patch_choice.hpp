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
    patch::PatchOverrides overrides;
    std::optional<std::uint64_t> seed;
};

}  // namespace tactus::session

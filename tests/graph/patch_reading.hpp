// SPDX-License-Identifier: Apache-2.0
// Reading patch text in tests.
#pragma once

#include "graph/patch/patch.hpp"

#include <string>
#include <string_view>

namespace tactus {

/// What every problem says, a line each.
inline std::string said(const patch::Problems& problems) {
    std::string text;
    for (const Error& error : problems.list) text += std::string(error.what()) + "\n";
    return text;
}

/// The patch in `text`, as if it stood in "folder/p.toml".
inline patch::Patch patch_of(std::string_view text) {
    patch::Problems problems;
    patch::Patch patch = patch::read_patch(text, "folder/p.toml", problems);
    if (!problems.empty()) throw problems.list.front();
    return patch;
}

inline std::string problems_of(std::string_view text) {
    patch::Problems problems;
    patch::read_patch(text, "p.toml", problems);
    return said(problems);
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// Nodes and comments, counted in words.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace tactus::window {

/// "2 nodes and 1 comment"; nothing is said of no comments.
inline std::string count_of(std::size_t nodes, std::size_t comments = 0) {
    const auto said = [](std::size_t count, const char* what) {
        return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
    };
    if (comments == 0) return said(nodes, "node");
    return (nodes == 0 ? "" : said(nodes, "node") + " and ") + said(comments, "comment");
}

}  // namespace tactus::window

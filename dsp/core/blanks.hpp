// SPDX-License-Identifier: Apache-2.0
// Blanks around words.
#pragma once

#include <cstddef>
#include <string_view>

namespace tactus {

inline constexpr std::string_view blanks = " \t\r";

/// Without blanks at both ends.
constexpr std::string_view without_blanks(std::string_view text) noexcept {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace tactus

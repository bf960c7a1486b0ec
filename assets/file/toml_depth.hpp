// SPDX-License-Identifier: Apache-2.0
// A guard in front of the TOML parser, which nests one table per dot of a key and frees them by recursion.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace tactus::file {

/// Dots that one key may have: no file of ours needs more than two, as in [nodes.hand].
inline constexpr int most_dots_in_key = 32;

/// Offset of the first dot that is one too many, or nothing. Dots in strings and comments do not count.
std::optional<std::size_t> overlong_key(std::string_view toml);

}  // namespace tactus::file

// SPDX-License-Identifier: Apache-2.0
// Guards the TOML parser against stack overflow: it nests one table per dot of a key and frees them recursively.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace tactus::file {

/// Maximum number of dots in a key. The file formats of this program need at most two, as in [nodes.hand].
inline constexpr int max_dots_in_key = 32;

/// Offset of the first dot beyond the limit, if any. Dots in strings and comments do not count.
std::optional<std::size_t> overlong_key(std::string_view toml);

}  // namespace tactus::file

// SPDX-License-Identifier: Apache-2.0
// "1 node", "3 nodes".
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace tactus {

/// A number and its noun, which takes an s in the plural.
inline std::string counted(std::integral auto number, std::string_view noun) {
    return std::to_string(number) + ' ' + std::string(noun) + (number == 1 ? "" : "s");
}

}  // namespace tactus

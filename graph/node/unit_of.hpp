// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace tactus {

/// Returns the unit of a quantity, "0.2 kg" → "kg". For valid literals of the program only.
inline std::string_view unit_of(std::string_view quantity) {
    const std::size_t space = quantity.find(' ');
    return space == std::string_view::npos ? std::string_view{} : quantity.substr(space + 1);
}

}  // namespace tactus

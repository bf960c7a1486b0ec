// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace tactus {

/// "0.2 kg" → "kg": the unit of a quantity of the program itself, which is valid.
inline std::string_view unit_of(std::string_view quantity) {
    const std::size_t space = quantity.find(' ');
    return space == std::string_view::npos ? std::string_view{} : quantity.substr(space + 1);
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// Comparison of words without regard to upper and lower case.
#pragma once

#include <string>
#include <string_view>

namespace tactus {

/// ASCII letters become small, in any locale; other bytes stay.
inline std::string lower(std::string_view text) {
    std::string made(text);
    for (char& c : made)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return made;
}

}  // namespace tactus

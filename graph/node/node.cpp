// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cctype>

namespace tactus {

std::string type_name_of(std::string_view struct_name) {
    std::string name;
    for (const char c : struct_name) {
        const auto u = static_cast<unsigned char>(c);
        if (std::isupper(u) && !name.empty()) name += '_';
        name += static_cast<char>(std::tolower(u));
    }
    return name;
}

}  // namespace tactus

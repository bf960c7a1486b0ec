// SPDX-License-Identifier: Apache-2.0
// Five laws as formulas and as C++ nodes.
#pragma once

#include "graph/node/node.hpp"

#include <span>
#include <string_view>

namespace tactus::bench {

struct Law {
    std::string_view formula, constants, type;
    int inputs = 1;  ///< x, and y
};

std::span<const Law> laws();
/// The types that `laws` names.
std::span<const NodeType* const> law_nodes();

}  // namespace tactus::bench

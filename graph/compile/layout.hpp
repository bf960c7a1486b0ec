// SPDX-License-Identifier: Apache-2.0
// Where the values of outputs lie: one block of memory for all of them. The last pass of the compiler.
#pragma once

#include "graph/compile/plan.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::compile {

struct ValueLayout {
    std::vector<std::vector<std::size_t>> offsets;  ///< of each node's outputs, bytes
    std::size_t bytes = 0;
};

/// Places every output; `frames[group]` values of it when the group has audio, else one. A signal that is read only
/// within its group and call gives its place to a later one once its last reader has run, so that a long chain stays
/// in the nearest cache: its values are there from its own step to that of its last reader, and no longer. Everything
/// else keeps its place, and its last value, for good.
ValueLayout lay_out_values(const Plan& plan, std::span<const int> frames);

/// Alignment of the block.
inline constexpr std::size_t value_alignment = 64;

}  // namespace tactus::compile

// SPDX-License-Identifier: Apache-2.0
// Memory layout of the values of outputs: one block for all of them. The last pass of the compiler.
#pragma once

#include "graph/compile/schedule.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::compile {

struct ValueLayout {
    std::vector<std::vector<std::size_t>> offsets;  ///< byte offsets of each node's outputs
    std::size_t bytes = 0;
};

/// Assigns memory to every output: `frames[group]` values if the group has audio, otherwise one. The memory of a signal
/// that is read only within its group and call is reused after its last reader has run, so that a long chain stays in
/// the nearest cache. Such a signal is valid only from its own step to that of its last reader. All other outputs keep
/// their memory and their last value.
ValueLayout lay_out_values(const Schedule& plan, std::span<const int> frames);

/// Alignment of the block.
inline constexpr std::size_t value_alignment = 64;

}  // namespace tactus::compile

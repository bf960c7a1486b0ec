// SPDX-License-Identifier: Apache-2.0
// Where nodes live: those made one after another lie one after another, each on cache lines of its own. A long chain
// then streams through the caches, and nodes of different threads never share a line. A node begins where an input that
// stands first ends its line: what every call touches of a node with one input, one output and one parameter then lies
// on the line that follows.
#pragma once

#include <cstddef>

namespace tactus {

inline constexpr std::size_t cache_line = 64;
inline constexpr std::size_t node_offset = 16;  ///< bytes from the beginning of a line to a node, and its alignment

/// Room for one node, `node_offset` behind the beginning of a line. Any thread. Throws std::bad_alloc.
void* take_node_memory(std::size_t bytes);

/// Gives back what take_node_memory gave for the same number of bytes. Any thread.
void give_back_node_memory(void* memory, std::size_t bytes) noexcept;

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// Memory of nodes. Nodes that one thread makes in sequence are adjacent, each on cache lines of its own: a long chain
// streams through the caches, and nodes of different threads never share a line. `node_offset` is chosen so that a
// first member of type Input ends at the end of its line. In a node with one input, one output and one parameter, the
// data of every call then fits into the following line.
#pragma once

#include <cstddef>

namespace tactus {

inline constexpr std::size_t cache_line = 64;
inline constexpr std::size_t node_offset = 16;  ///< bytes from the beginning of a line to a node, and its alignment

/// Allocates memory for one node, `node_offset` bytes after the start of a cache line. Any thread may call it. Throws
/// std::bad_alloc.
void* take_node_memory(std::size_t bytes);

/// Frees memory from take_node_memory; `bytes` as passed there. Any thread may call it.
void give_back_node_memory(void* memory, std::size_t bytes) noexcept;

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// Where nodes live: those made one after another lie one after another, each on cache lines of its own. A long chain
// then streams through the caches, and nodes of different threads never share a line.
#pragma once

#include <cstddef>

namespace tactus {

inline constexpr std::size_t node_alignment = 64;

/// Room for one node, aligned to node_alignment. Any thread. Throws std::bad_alloc.
void* take_node_memory(std::size_t bytes);

/// Gives back what take_node_memory gave for the same number of bytes. Any thread.
void give_back_node_memory(void* memory, std::size_t bytes) noexcept;

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node_memory.hpp"

#if __has_include(<sanitizer/asan_interface.h>)
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(address, size) (static_cast<void>(0))
#define ASAN_UNPOISON_MEMORY_REGION(address, size) (static_cast<void>(0))
#endif

#include <atomic>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>

namespace tactus {

namespace {

constexpr std::size_t line = cache_line;
constexpr std::size_t chunk_bytes = 64 << 10;
constexpr std::size_t largest_in_chunk = chunk_bytes / 4;

/// Memory for several nodes. It is aligned to its size, so a node's address gives its chunk. It is freed when it holds
/// no node and no thread fills it.
struct alignas(line) Chunk {
    std::atomic<int> users{1};
    std::size_t used = line;  ///< bytes from the beginning on, whole lines

    void release() noexcept {
        if (users.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
        ASAN_UNPOISON_MEMORY_REGION(this, chunk_bytes);
        std::destroy_at(this);
        ::operator delete(this, chunk_bytes, std::align_val_t{chunk_bytes});
    }
};

/// The chunk that this thread fills.
struct Filling {
    Chunk* chunk = nullptr;
    Filling() = default;
    Filling(const Filling&) = delete;
    Filling& operator=(const Filling&) = delete;
    ~Filling() {
        if (chunk) chunk->release();
    }
};

/// An odd number of whole lines: the data of many equal nodes then spreads over all sets of a cache.
std::size_t room_for(std::size_t bytes) { return ((node_offset + bytes + line - 1) / line | 1) * line; }

}  // namespace

void* take_node_memory(std::size_t bytes) {
    const std::size_t size = room_for(bytes);
    if (size > largest_in_chunk)
        return static_cast<std::byte*>(::operator new(size, std::align_val_t{line})) + node_offset;
    thread_local Filling filling;
    if (!filling.chunk || filling.chunk->used + size > chunk_bytes) {
        void* fresh = ::operator new(chunk_bytes, std::align_val_t{chunk_bytes});
        if (Chunk* full = std::exchange(filling.chunk, new (fresh) Chunk)) full->release();
        ASAN_POISON_MEMORY_REGION(filling.chunk + 1, chunk_bytes - sizeof(Chunk));
    }
    Chunk& chunk = *filling.chunk;
    auto* place = reinterpret_cast<std::byte*>(&chunk) + chunk.used + node_offset;
    chunk.used += size;
    chunk.users.fetch_add(1, std::memory_order_relaxed);
    ASAN_UNPOISON_MEMORY_REGION(place, bytes);
    return place;
}

void give_back_node_memory(void* memory, std::size_t bytes) noexcept {
    const std::size_t size = room_for(bytes);
    if (size > largest_in_chunk)
        return ::operator delete(static_cast<std::byte*>(memory) - node_offset, size, std::align_val_t{line});
    ASAN_POISON_MEMORY_REGION(memory, size - node_offset);
    reinterpret_cast<Chunk*>(reinterpret_cast<std::uintptr_t>(memory) & ~(chunk_bytes - 1))->release();
}

}  // namespace tactus

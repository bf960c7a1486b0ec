// SPDX-License-Identifier: Apache-2.0
// A value in shared memory with one writer and any number of readers, none of which waits (H.-J. Boehm, Can seqlocks
// get along with programming language memory models?, MSPC 2012; release and acquire on each word instead of fences).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tactus::hosted {

template <class T>
class Seqlock {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 8 == 0);
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "other processes read it");
    static constexpr std::size_t size = sizeof(T) / 8;

public:
    /// Wait-free. Writers must take turns, and each must see the write of the previous one.
    void write(const T& value) noexcept {
        std::array<std::uint64_t, size> words;
        std::memcpy(words.data(), &value, sizeof(T));
        const std::uint64_t before = sequence_.load(std::memory_order_relaxed);
        // A writer that was killed during a write has left an odd number.
        const std::uint64_t begun = (before | 1u) + (before & 1u ? 2u : 0u);
        sequence_.store(begun, std::memory_order_relaxed);
        for (std::size_t i = 0; i < size; ++i) words_[i].store(words[i], std::memory_order_release);
        sequence_.store(begun + 1, std::memory_order_release);
    }

    /// Reads the newest value, and a number that differs for each value written; 0: none yet. Returns false, with
    /// nothing changed, if every attempt collided with the writer. Wait-free.
    bool read(T& value, std::uint64_t& number) const noexcept {
        constexpr int tries = 8;
        for (int i = 0; i < tries; ++i) {
            const std::uint64_t begin = sequence_.load(std::memory_order_acquire);
            std::array<std::uint64_t, size> words;
            for (std::size_t w = 0; w < size; ++w) words[w] = words_[w].load(std::memory_order_acquire);
            if ((begin & 1u) != 0 || sequence_.load(std::memory_order_relaxed) != begin) continue;
            std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
            number = begin;
            return true;
        }
        return false;
    }

private:
    std::atomic<std::uint64_t> sequence_{0};
    std::array<std::atomic<std::uint64_t>, size> words_{};
};

}  // namespace tactus::hosted

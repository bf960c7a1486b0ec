// SPDX-License-Identifier: Apache-2.0
// Lock-free single-producer single-consumer (SPSC) ring buffer.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace tactus {

/// Queue for exactly one writing and one reading thread. Each side keeps its counter on its own cache line, with a copy
/// of the other's, so the lines move between cores only when the copy is exhausted.
template <typename T>
class Ring {
    static_assert(std::is_trivially_destructible_v<T>, "slots are overwritten without destructors");
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

public:
    /// Holds at least `capacity` values (rounded up to a power of two). Allocates; nothing else does.
    explicit Ring(std::size_t capacity)
        : mask_(std::bit_ceil(std::max<std::size_t>(capacity, 1)) - 1), slots_(std::make_unique<T[]>(mask_ + 1)) {}
    Ring(const Ring&) = delete;
    Ring& operator=(const Ring&) = delete;

    std::size_t capacity() const noexcept { return mask_ + 1; }

    /// Appends the first values that fit and returns how many did. Writer only; wait-free.
    std::size_t push(const T* values, std::size_t count) noexcept {
        const std::uint64_t written = writer_.count.load(std::memory_order_relaxed);
        if (capacity() - (written - writer_.other) < count)
            writer_.other = reader_.count.load(std::memory_order_acquire);
        count = std::min<std::size_t>(count, capacity() - (written - writer_.other));
        const std::size_t at = written & mask_, first = std::min(count, capacity() - at);
        std::copy_n(values, first, slots_.get() + at);
        std::copy_n(values + first, count - first, slots_.get());
        writer_.count.store(written + count, std::memory_order_release);
        return count;
    }
    /// False when full. Writer only; wait-free.
    bool push(const T& value) noexcept { return push(&value, 1) == 1; }

    /// Removes up to `count` values, oldest first, and returns how many. Reader only; wait-free.
    std::size_t pop(T* values, std::size_t count) noexcept {
        const std::uint64_t read = reader_.count.load(std::memory_order_relaxed);
        if (reader_.other - read < count) reader_.other = writer_.count.load(std::memory_order_acquire);
        count = std::min<std::size_t>(count, reader_.other - read);
        const std::size_t at = read & mask_, first = std::min(count, capacity() - at);
        std::copy_n(slots_.get() + at, first, values);
        std::copy_n(slots_.get(), count - first, values + first);
        reader_.count.store(read + count, std::memory_order_release);
        return count;
    }
    /// False when empty. Reader only; wait-free.
    bool pop(T& value) noexcept { return pop(&value, 1) == 1; }

    /// Values waiting: a lower bound for the reader, an upper bound for the writer. Wait-free.
    std::size_t size() const noexcept {
        const std::uint64_t read = reader_.count.load(std::memory_order_acquire);
        const std::uint64_t written = writer_.count.load(std::memory_order_acquire);
        return std::min<std::size_t>(written - read, capacity());
    }
    /// Room left: a lower bound for the writer. Wait-free.
    std::size_t space() const noexcept { return capacity() - size(); }

private:
    struct alignas(64) Side {
        std::atomic<std::uint64_t> count{0};  // number of values that this side has moved
        std::uint64_t other = 0;  // copy of the other side's count
    };

    std::size_t mask_;
    std::unique_ptr<T[]> slots_;
    Side writer_, reader_;
};

}  // namespace tactus

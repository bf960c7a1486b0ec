// SPDX-License-Identifier: Apache-2.0
// A delayed wire within a group: its values arrive a number of activations later.
#pragma once

#include "graph/node/param.hpp"
#include "graph/node/port.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace tactus::build {

/// Returns the value of `count` activations ago. Group's thread; wait-free.
struct DelayLine {
    const ValueType* type = nullptr;
    const Output* source = nullptr;
    const std::byte* values = nullptr;  ///< of the source in this call
    std::ptrdiff_t stride = 0;
    Input* target = nullptr;
    Param* param = nullptr;
    std::int64_t count = 1;
    std::vector<std::byte> history;  ///< `count` values, activation index modulo count
    std::vector<std::byte> delayed;  ///< the values of this call
    DelayLine* before = nullptr;     ///< the same wire in the previous program, whose history continues

    /// Fills `delayed` for `activations` activations of a call, starting with its activation `from`, which has index
    /// `tick`. May exceed `count` only if the source has already run for them.
    void recall(std::int64_t tick, int from, int activations) noexcept {
        for (int i = 0; i < activations; ++i)
            std::memcpy(delayed.data() + static_cast<std::size_t>(from + i) * type->size,
                        i < count ? place(tick + i) : values + (from + i - count) * stride, type->size);
    }
    /// Stores the values of those activations that later ones will read.
    void remember(std::int64_t tick, int from, int activations) noexcept {
        for (auto i = static_cast<int>(std::max<std::int64_t>(0, activations - count)); i < activations; ++i)
            std::memcpy(place(tick + i), values + (from + i) * stride, type->size);
    }
    /// For snapshots: the smallest version in the history.
    std::int64_t oldest_version() const noexcept {
        std::int64_t oldest = std::numeric_limits<std::int64_t>::max();
        for (std::size_t at = 0; at < history.size(); at += type->size)
            oldest = std::min(oldest, type->version(history.data() + at));
        return oldest;
    }

private:
    std::byte* place(std::int64_t tick) { return history.data() + static_cast<std::size_t>(tick % count) * type->size; }
};

}  // namespace tactus::build

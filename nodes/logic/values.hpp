// SPDX-License-Identifier: Apache-2.0
// Copying and defaults of values of any plain type.
#pragma once

#include "graph/node/port.hpp"
#include "graph/node/setup.hpp"

#include <cstddef>
#include <cstring>

namespace tactus::nodes {

/// Copies the value of a call: one value, or the samples of a signal.
inline void copy_value(const std::byte* from, AnyOut& to, const Tick& tick) noexcept {
    const auto count = static_cast<std::size_t>(to.type == &value::signal ? tick.frames : 1);
    std::memcpy(to.data, from, count * to.type->size);
}

/// Writes the type's default: zero, identity, false, silence.
inline void put_default(AnyOut& to, const Tick& tick) noexcept {
    const int count = to.type == &value::signal ? tick.frames : 1;
    for (int i = 0; i < count; ++i) to.type->make_default(to.data + static_cast<std::size_t>(i) * to.type->size);
}

}  // namespace tactus::nodes

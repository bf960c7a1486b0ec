// SPDX-License-Identifier: Apache-2.0
// Frames of the outputs of a rate group: a frame holds the values of all outputs at one activation.
#pragma once

#include "graph/node/value.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace tactus::io {

struct FrameColumn {
    std::string port;  ///< "node.port"
    const ValueType* type = nullptr;
    std::size_t offset = 0;  ///< in the frame, bytes

    bool operator==(const FrameColumn&) const = default;
};

struct FrameLayout {
    std::vector<FrameColumn> columns;
    std::size_t bytes = 0;  ///< distance from one frame to the next
    std::size_t used = 0;   ///< of `bytes`, without padding

    /// Adds an output at the end and returns its offset.
    std::size_t add(const std::string& port, const ValueType& type) {
        const std::size_t alignment = std::min<std::size_t>(8, type.size);
        const std::size_t offset = (used + alignment - 1) / alignment * alignment;
        columns.push_back({port, &type, offset});
        used = offset + type.size;
        bytes = (used + 7) / 8 * 8;
        return offset;
    }
    bool operator==(const FrameLayout&) const = default;
};

}  // namespace tactus::io

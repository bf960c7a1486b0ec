// SPDX-License-Identifier: Apache-2.0
// Range and type of many values.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::volume {

struct ValueRange {
    float low = 0.0f, high = 0.0f;
    std::size_t zeros = 0;
    bool finite = true, whole = true;  ///< all finite; all integers of magnitude up to two billion
};
/// Returns the range of at least one value.
ValueRange range_of(std::span<const float> values);

}  // namespace tactus::volume

// SPDX-License-Identifier: Apache-2.0
// What many values have in common.
#pragma once

#include <cstddef>
#include <span>

namespace tactus::volume {

struct ValueRange {
    float low = 0.0f, high = 0.0f;
    std::size_t zeros = 0;
    bool finite = true, whole = true;  ///< all are; whole: numbers without a fraction, and none beyond two billion
};
/// Of at least one value.
ValueRange range_of(std::span<const float> values);

}  // namespace tactus::volume

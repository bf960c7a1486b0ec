// SPDX-License-Identifier: Apache-2.0
// The value in the middle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tactus {

/// Of an even number of values, the upper one of the two in the middle. There must be a value.
inline double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace tactus

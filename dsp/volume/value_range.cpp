// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/value_range.hpp"

#include <bit>
#include <cstdint>

namespace tactus::volume {

ValueRange range_of(std::span<const float> values) {
    float low = values[0], high = values[0];
    std::uint32_t zeros = 0, odd = 0;
    for (const float value : values) {
        low = value < low ? value : low;
        high = value > high ? value : high;
        zeros += value == 0.0f;
        odd |= (std::bit_cast<std::uint32_t>(value) & 0x7f800000u) == 0x7f800000u;
    }
    ValueRange range{low, high, zeros, odd == 0, false};
    if (!range.finite || low < -2e9f || high > 2e9f) return range;
    std::uint32_t broken = 0;
    for (const float value : values) broken |= static_cast<float>(static_cast<std::int32_t>(value)) != value;
    range.whole = broken == 0;
    return range;
}

}  // namespace tactus::volume

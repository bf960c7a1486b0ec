// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/compact_slice.hpp"

#include <algorithm>
#include <bit>

namespace tactus::volume {

CompactSlice::CompactSlice(std::span<const float> values) {
    if (values.empty()) return;
    float low = values[0], high = values[0];
    std::uint32_t odd = 0;
    for (const float value : values) {
        odd |= (std::bit_cast<std::uint32_t>(value) & 0x7f800000u) == 0x7f800000u;
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    std::uint32_t lost = odd != 0 || !(low >= -1e6f && high <= 1e6f && high - low <= 65535.0f);
    if (lost == 0) {
        offset_ = static_cast<std::int32_t>(low) + 32768;
        shorts_.resize(values.size());
        for (std::size_t n = 0; n < values.size(); ++n) {
            const auto whole = static_cast<std::int32_t>(values[n]);
            shorts_[n] = static_cast<std::int16_t>(whole - offset_);
            // Every bit, including the sign of -0.
            lost |= std::bit_cast<std::uint32_t>(static_cast<float>(whole)) ^ std::bit_cast<std::uint32_t>(values[n]);
        }
    }
    if (lost == 0) return;
    shorts_ = {};
    floats_.assign(values.begin(), values.end());
}

void CompactSlice::copy(std::size_t first, std::span<float> into) const {
    if (floats_.empty()) {
        const std::int16_t* from = shorts_.data() + first;
        for (std::size_t n = 0; n < into.size(); ++n) into[n] = static_cast<float>(from[n] + offset_);
    } else {
        std::copy_n(floats_.begin() + static_cast<std::ptrdiff_t>(first), into.size(), into.begin());
    }
}

}  // namespace tactus::volume

// SPDX-License-Identifier: Apache-2.0
// Lossless compact storage of a slice of a volume.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::volume {

/// Two bytes per value when all are integers within 65536 of each other, as in nearly every CT; otherwise four.
class CompactSlice {
public:
    CompactSlice() = default;
    explicit CompactSlice(std::span<const float> values);

    bool empty() const { return shorts_.empty() && floats_.empty(); }
    float operator[](std::size_t n) const {
        return floats_.empty() ? static_cast<float>(shorts_[n] + offset_) : floats_[n];
    }
    /// Values from `first` on.
    void copy(std::size_t first, std::span<float> into) const;

private:
    std::vector<std::int16_t> shorts_;
    std::vector<float> floats_;
    std::int32_t offset_ = 0;
};

}  // namespace tactus::volume

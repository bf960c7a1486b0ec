// SPDX-License-Identifier: Apache-2.0
// Direct-form FIR filter: no latency of its own, the same cost at every sample.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// y[n] = Σ taps[k] x[n − k]. The sum has a fixed order of `lanes` partial sums, which compilers vectorise without
/// changing a bit of the result.
class Fir {
public:
    static constexpr std::size_t lanes = 16;

    Fir() : Fir(std::array{1.0f}) {}
    /// Allocates. Without taps it acts as the single tap 0.
    explicit Fir(std::span<const float> taps)
        : length_((taps.size() + lanes - 1) / lanes * lanes + (taps.empty() ? lanes : 0)),
          reversed_(length_, 0.0f),
          history_(2 * length_, 0.0f) {
        for (std::size_t k = 0; k < taps.size(); ++k) reversed_[length_ - 1 - k] = taps[k];
    }

    /// One sample. Wait-free, allocates nothing.
    float operator()(float x) noexcept {
        // Stored twice, so that the last `length_` samples are always contiguous.
        history_[at_] = history_[at_ + length_] = x;
        at_ = at_ + 1 == length_ ? 0 : at_ + 1;
        const float* oldest = history_.data() + at_;
        std::array<float, lanes> sums{};
        for (std::size_t i = 0; i < length_; i += lanes)
            for (std::size_t lane = 0; lane < lanes; ++lane) sums[lane] += reversed_[i + lane] * oldest[i + lane];
        float sum = 0.0f;
        for (const float part : sums) sum += part;
        return sum;
    }

    /// The input `delay` samples ago, 0 the newest; must be less than the number of taps.
    float past(std::size_t delay) const noexcept { return history_[at_ + length_ - 1 - delay]; }

private:
    std::size_t length_, at_ = 0;
    std::vector<float> reversed_, history_;
};

}  // namespace tactus::signal

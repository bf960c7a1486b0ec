// SPDX-License-Identifier: Apache-2.0
// The segment processing of all Welch estimates: remove the trend, apply the window, transform. Handles as many
// segments at once as a register has lanes.
#pragma once

#include "dsp/signal/spectrum/fft.hpp"
#include "dsp/signal/spectrum/window.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Trend that is subtracted from each segment before the window.
enum class Detrend { none, constant, linear };

template <class T>
class SegmentFft {
public:
    static constexpr std::size_t lanes = lane_count<T>;

    SegmentFft(std::size_t length, WindowKind window, Detrend detrend);

    std::size_t length() const noexcept { return window_.size(); }
    std::size_t bins() const noexcept { return window_.size() / 2 + 1; }
    /// The window, rounded to T.
    std::span<const T> window() const noexcept { return window_; }

    /// `starts`: start of up to `lanes` segments. Returns bins() complex values, interleaved, one lane per segment;
    /// unused lanes are zero. Valid until the next call.
    const Lanes<T>* operator()(std::span<const T* const> starts) noexcept;

private:
    Detrend detrend_;
    std::vector<T> window_;
    detail::RealFftPlan<T, Lanes<T>> plan_;
    std::vector<T> silence_;
};

}  // namespace tactus::signal

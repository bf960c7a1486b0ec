// SPDX-License-Identifier: Apache-2.0
// Regularises samples with uneven times.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

struct EvenRecord {
    double rate = 0.0;  ///< Hz: the mean rate of the input
    double usable =
        0.0;  ///< Hz: half the rate of the step that 99 % of steps do not exceed; content above it is unreliable
    double shortest_step = 0.0, longest_step = 0.0;  ///< s, without gaps
    std::size_t gaps = 0;  ///< steps of more than five medians; they are not interpolated
    double lost = 0.0;       ///< s in gaps
    double clock_step = 0.0;  ///< s: the samples are even and the clock rounded their times to this; 0: as they are
    /// pieces[p][channel]: even samples between gaps. Pieces of fewer than four samples are dropped.
    std::vector<std::vector<std::vector<double>>> pieces;
};

/// `times` (s) must not decrease. Times that are multiples of a common step, and that an even sampling explains within
/// that step, were rounded by a coarse clock: the even times are used, since rounding is no jitter of the samples (its
/// pattern would modulate every line). Otherwise samples with equal times are spread evenly up to the next. `channels`: values per
/// time. Interpolates each piece with a cubic spline, then fits it to
/// the samples as a band-limited function: the level of a tone below 0.4 of the rate stays within 0.5 % while the times
/// deviate from even ones by up to a fifth of a step. Components above half the rate were aliased at sampling, which
/// cannot be undone. Throws Error for fewer than four samples and for times that do not advance.
EvenRecord regularise(std::span<const double> times, std::span<const std::vector<double>> channels);

}  // namespace tactus::signal

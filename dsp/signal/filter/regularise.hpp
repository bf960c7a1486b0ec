// SPDX-License-Identifier: Apache-2.0
// Samples that were not taken at an even pace, moved to an even one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

struct EvenRecord {
    double rate = 0.0;       ///< Hz: the mean of what was there
    double usable = 0.0;     ///< Hz: half of one over the step that 99 % of steps do not exceed; above it, guesswork
    double shortest_step = 0.0, longest_step = 0.0;  ///< s, gaps not counted
    std::size_t gaps = 0;    ///< steps of more than five medians: nothing is made up for them
    double lost = 0.0;       ///< s in gaps
    /// pieces[p][channel]: even samples between gaps. Pieces of fewer than four samples are dropped.
    std::vector<std::vector<std::vector<double>>> pieces;
};

/// `times` (s) must not decrease; samples with one time are spread evenly up to the next. `channels`: values per time. A cubic
/// spline goes through each piece. Components above half the rate were folded when the samples were taken; nothing
/// can undo that. Throws Error when there are fewer than four samples or time stands still.
EvenRecord regularise(std::span<const double> times, std::span<const std::vector<double>> channels);

}  // namespace tactus::signal

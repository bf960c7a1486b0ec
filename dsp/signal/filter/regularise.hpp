// SPDX-License-Identifier: Apache-2.0
// Regularises samples with uneven times.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace tactus::signal {

/// Samples with their times, which need not be in memory: both functions fill a span from sample `first` on.
struct TimedSamples {
    std::size_t count = 0, channels = 0;
    std::function<void(std::size_t first, std::span<double> out)> times;  ///< s; must not decrease
    std::function<void(std::size_t channel, std::size_t first, std::span<double> out)> values;
};

/// Statistics of the times of a record.
struct EvenFacts {
    double rate = 0.0;  ///< Hz: the mean rate of the input
    double usable =
        0.0;  ///< Hz: half the rate of the step that 99 % of steps do not exceed; content above it is unreliable
    double shortest_step = 0.0, longest_step = 0.0;  ///< s, without gaps
    double step_deviation = 0.0;  ///< s: standard deviation of the steps of the given times, without gaps
    std::size_t gaps = 0;  ///< steps of more than five medians; they are not interpolated
    double lost = 0.0;       ///< s, of the samples that are missing in gaps
    double clock_step =
        0.0;  ///< s: step to which a clock rounded the times of even samples; 0: none, or below 1 % of theirs
    std::size_t frames = 0;   ///< even samples in all pieces
};

/// Returns even samples in blocks, in constant memory except for 40 bytes per gap. Times that are
/// multiples of a common step, and that differ from even sampling by less than that step, were rounded by a coarse
/// clock: even times are used instead, since rounding is not a jitter of the samples and its pattern would modulate
/// every line. Otherwise samples with equal times are spread evenly up to the next. Interpolates each piece between
/// gaps with a cubic spline, then fits it to the samples as a band-limited function: the level of a tone below 0.4 of
/// the rate stays within 0.5 % while the times deviate from even ones by up to a fifth of a step. Components above half
/// the rate were aliased at sampling, which cannot be undone. Samples that are even already are passed through. Pieces
/// longer than 131072 samples are computed in parts of 65536 with 512 more on each side, where the influence of the
/// border has decayed. Pieces of fewer than four samples are dropped.
class Regulariser {
public:
    /// Reads all times several times. Throws Error for fewer than four samples and for times that do not advance.
    explicit Regulariser(TimedSamples samples);
    ~Regulariser();
    Regulariser(Regulariser&&) noexcept;
    Regulariser& operator=(Regulariser&&) noexcept;

    const EvenFacts& facts() const noexcept;
    /// The next block, of equal length in each channel, at least one sample; false at the end. `after_gap`: it does not
    /// continue the previous block.
    bool next(std::vector<std::vector<double>>& block, bool& after_gap);
    void rewind();

private:
    struct State;
    std::unique_ptr<State> state_;
};

struct EvenRecord : EvenFacts {
    /// pieces[p][channel]: even samples between gaps.
    std::vector<std::vector<std::vector<double>>> pieces;
};

/// The whole record at once. `channels`: values per time.
EvenRecord regularise(std::span<const double> times, std::span<const std::vector<double>> channels);

}  // namespace tactus::signal

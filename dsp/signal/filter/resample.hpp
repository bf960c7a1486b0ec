// SPDX-License-Identifier: Apache-2.0
// Sample-rate conversion by a windowed sinc.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Converts `samples` from `from` Hz to `to` Hz, starting at time `start` (s, clock of the record). Flat within 0.01 dB
/// up to 0.4 of the lower rate; aliases below that are attenuated by 80 dB. Silence outside of the record. Fastest for
/// exact ratios of small integers. Throws Error for rates that are not positive. Allocates.
std::vector<double> resample(std::span<const float> samples, double from, double to, double start = 0.0);
std::vector<double> resample(std::span<const double> samples, double from, double to, double start = 0.0);

/// The same, with the same bits, for a record of `frames` samples that comes in pieces, in constant memory.
class ResamplingStream {
public:
    /// Throws Error for rates that are not positive.
    ResamplingStream(std::size_t frames, double from, double to, double start = 0.0);

    /// Total number of output values.
    std::size_t frames() const noexcept { return count_; }
    /// Takes the next samples and appends the output values that are final: all of them with the last sample.
    template <class Sample>
    void push(std::span<const Sample> samples, std::vector<double>& out);

private:
    double begin_, step_;  // samples: position of the first value; distance of values
    std::ptrdiff_t reach_ = 0, size_;
    std::size_t count_ = 0, done_ = 0;
    std::vector<double> kernel_;  // one side, finely tabulated
    double kernel_reach_ = 0.0;  // samples
    struct Phase {
        std::ptrdiff_t whole;  // samples before it, from the position of the period's first value on
        std::vector<double> taps;
    };
    std::vector<Phase> phases_;  // taps of one period of values, if the fraction repeats soon
    std::ptrdiff_t period_ = 0;  // samples
    std::vector<double> own_, held_;  // taps of one fraction; samples still needed
    std::ptrdiff_t held_from_ = 0;  // index of the first of them
};

}  // namespace tactus::signal

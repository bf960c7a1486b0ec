// SPDX-License-Identifier: Apache-2.0
// Sound at another sample rate, by a windowed sinc.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// `samples` taken at `from` Hz, as if taken at `to` Hz from time `start` (s, of the record's clock) on. Flat within
/// 0.01 dB up to 0.4 of the lower rate; what would fold back below that is 80 dB down. Outside of the record there is
/// silence. Exact ratios of small whole numbers are fastest. Throws Error for rates that are not positive. Allocates.
std::vector<double> resample(std::span<const float> samples, double from, double to, double start = 0.0);
std::vector<double> resample(std::span<const double> samples, double from, double to, double start = 0.0);

/// The same, bit by bit, for a record of `frames` samples that comes in pieces, in memory that does not grow with it.
class ResamplingStream {
public:
    /// Throws Error for rates that are not positive.
    ResamplingStream(std::size_t frames, double from, double to, double start = 0.0);

    /// How many values come out in all.
    std::size_t frames() const noexcept { return count_; }
    /// Takes the next samples and appends to `out` the values that are certain now: all of them with the last sample.
    template <class Sample>
    void push(std::span<const Sample> samples, std::vector<double>& out);

private:
    double begin_, step_;  // samples: place of the first value, from one value to the next
    std::ptrdiff_t reach_ = 0, size_;
    std::size_t count_ = 0, done_ = 0;
    std::vector<double> kernel_;  // one side, finely tabulated
    double kernel_reach_ = 0.0;  // samples
    struct Phase {
        std::ptrdiff_t whole;  // samples before it, from the place of the period's first value on
        std::vector<double> taps;
    };
    std::vector<Phase> phases_;  // of the values until the fraction comes back, if that is soon
    std::ptrdiff_t period_ = 0;  // samples
    std::vector<double> own_, held_;  // taps of one fraction; samples still needed
    std::ptrdiff_t held_from_ = 0;  // index of the first of them
};

}  // namespace tactus::signal

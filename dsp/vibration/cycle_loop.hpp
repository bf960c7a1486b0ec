// SPDX-License-Identifier: Apache-2.0
// A seamless loop of a whole number of cycles, indexed by cycle instead of time.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::vibration {

/// Made from a recording of a process with `reciprocation_rate` cycles per second. The loop is stored near the output's
/// sample rate with a whole number of samples, so that it closes without a gap.
class CycleLoop {
public:
    static constexpr int orders = 8;  ///< number of harmonics used to align and compare loops
    static constexpr double longest = 20.0;  ///< s; only the first part of a longer record is used
    static constexpr std::size_t fewest_cycles = 8;

    /// Rates in Hz. Among the longest loops, chooses the number of cycles after which the sound repeats itself best;
    /// the end is cross-faded into the sound before the start. Content above 0.42 × output rate is removed, so that
    /// playing 15 % faster does not alias. Throws Error when the record is shorter than 8 cycles.
    CycleLoop(std::span<const float> samples, double sample_rate, double reciprocation_rate, double output_rate);

    /// The sample at a phase in cycles, any number ≥ 0 (windowed sinc of 16 points).
    double operator()(double cycles) const noexcept;

    double power() const { return power_; }  ///< mean square
    std::size_t cycles() const { return cycles_; }

    /// Shifts the phase for the best agreement of the harmonics with those of `reference`.
    void align(const CycleLoop& reference);

    /// Correlation coefficient of two loops played at the same phase, from their harmonics: 1 for equal loops, 0 for
    /// noise; at least −0.5 (a fade between opposites would need unbounded gain).
    friend double likeness(const CycleLoop& a, const CycleLoop& b);

private:
    std::vector<float> samples_;  // with guard samples on both sides
    std::array<std::complex<double>, orders> harmonics_{};
    std::size_t cycles_ = 0, count_ = 0;
    double offset_ = 0.0;  // cycles, in [0, 1)
    double samples_per_cycle_ = 0.0, power_ = 0.0;
};

double likeness(const CycleLoop& a, const CycleLoop& b);

/// Gain for a sum of two signals with weights 1 − x and x and that correlation, so that the power is
/// (1 − x) power_a + x power_b.
double fade_gain(double x, double power_a, double power_b, double correlation);

}  // namespace tactus::vibration

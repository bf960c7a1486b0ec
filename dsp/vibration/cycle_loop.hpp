// SPDX-License-Identifier: Apache-2.0
// A seamless loop of a whole number of cycles, read by cycle instead of by time.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::vibration {

/// Made from a recording of something that repeats `reciprocation_rate` times per second. The loop is stored at about
/// the output's sample rate with a whole number of samples, so that it closes without a gap.
class CycleLoop {
public:
    static constexpr int orders = 8;               ///< harmonics by which loops are aligned and compared
    static constexpr double longest = 20.0;        ///< s; of a longer record the first part is used
    static constexpr std::size_t fewest_cycles = 8;

    /// Rates in Hz. The number of cycles is the one, among the longest, after which the sound repeats itself best;
    /// the end is cross-faded into what precedes the start. Sound above 0.42 × output rate is removed, so playing 15 %
    /// faster does not fold. Throws Error when the record is shorter than 8 cycles.
    CycleLoop(std::span<const float> samples, double sample_rate, double reciprocation_rate, double output_rate);

    /// The sample at a phase in cycles, any number ≥ 0 (windowed sinc of 16 points).
    double operator()(double cycles) const noexcept;

    double power() const { return power_; }  ///< mean square
    std::size_t cycles() const { return cycles_; }

    /// Shifts the phase so that the harmonics agree as well as possible with those of `reference`.
    void align(const CycleLoop& reference);

    /// Correlation coefficient of two loops played on one phase, from their harmonics: 1 when they repeat each other,
    /// 0 for noise, not below −0.5 (a fade between opposites would need unbounded gain).
    friend double likeness(const CycleLoop& a, const CycleLoop& b);

private:
    std::vector<float> samples_;  // with guard samples on both sides
    std::array<std::complex<double>, orders> harmonics_{};
    std::size_t cycles_ = 0, count_ = 0;
    double offset_ = 0.0;  // cycles, in [0, 1)
    double samples_per_cycle_ = 0.0, power_ = 0.0;
};

double likeness(const CycleLoop& a, const CycleLoop& b);

/// Common gain for a sum of two with weights 1 − x and x and that correlation, so that the power follows
/// (1 − x) power_a + x power_b.
double fade_gain(double x, double power_a, double power_b, double correlation);

}  // namespace tactus::vibration

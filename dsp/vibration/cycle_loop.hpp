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

    /// Rates in Hz. Among the longest loops, chooses the number of cycles with the best repetition; the end is
    /// cross-faded into the sound before the start. Content above 0.42 × output rate is removed. For playing up to
    /// `max_ratio` times as fast, it keeps versions of which each holds half of the bandwidth of the one before
    /// (Williams, Pyramidal parametrics, 1983), so that no component is played above half of the output rate. Throws
    /// Error when the record is shorter than 8 cycles.
    CycleLoop(std::span<const float> samples, double sample_rate, double reciprocation_rate, double output_rate,
              double max_ratio = 1.0);

    /// The sample at a phase in cycles, any number ≥ 0 (windowed sinc of 16 points). `ratio`: the rate at which the loop
    /// is played over the recorded one; it chooses the version. The level of the sound does not depend on it.
    double operator()(double cycles, double ratio = 1.0) const noexcept;

    double power() const { return power_; }  ///< mean square
    std::size_t cycles() const { return cycles_; }

    /// Shifts the phase for the best agreement of the harmonics with those of `reference`.
    void align(const CycleLoop& reference);

    /// Correlation coefficient of two loops played at the same phase, from their harmonics: 1 for equal loops, 0 for
    /// noise; at least −0.5 (a fade between opposites would need unbounded gain).
    friend double likeness(const CycleLoop& a, const CycleLoop& b);

private:
    /// One bandwidth of the loop, with guard samples on both sides. Content lies below 0.21 × the rate of the samples,
    /// where the images that remain after the sinc are below −70 dB.
    struct Version {
        std::vector<float> samples;
        std::size_t count = 0;  // samples of the loop
        double power = 0.0;
    };

    void add_version(const std::vector<double>& loop);
    double read(const Version& version, double part) const noexcept;

    std::vector<Version> versions_;  // the first has all content, at twice the output rate
    std::array<std::complex<double>, orders> harmonics_{};
    std::size_t cycles_ = 0;
    double offset_ = 0.0;  // cycles, in [0, 1)
    double samples_per_cycle_ = 0.0, power_ = 0.0;
};

double likeness(const CycleLoop& a, const CycleLoop& b);

/// Gain for a sum of two signals with weights 1 − x and x and that correlation, so that the power is
/// (1 − x) power_a + x power_b.
double fade_gain(double x, double power_a, double power_b, double correlation);

}  // namespace tactus::vibration

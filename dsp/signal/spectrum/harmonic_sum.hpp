// SPDX-License-Identifier: Apache-2.0
// Harmonic sums of a spectrum with a subharmonic check (after Hermes 1988, subharmonic summation).
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

struct HarmonicSum {
    double frequency = 0.0;  ///< Hz; 0: none
    double score = 0.0;      ///< 0 … 1
};

/// Returns the best fundamentals from `lowest` to `highest` Hz of a Hann spectrum, best first; none is within 3 % of
/// another or below five bins. The weight of an order is its level above the noise around it, at most 30 dB, so that
/// neither the strongest line nor a missing first order dominates. Multiples of the fundamental explain fewer lines,
/// and submultiples have missing orders. Allocates.
std::vector<HarmonicSum> harmonic_sums(const Spectrum& spectrum, double lowest, double highest, std::size_t most = 5);

/// Confidence, 0 … 1, in the best of the sums of one spectrum: its score, halved when a rival is as good.
double confidence_in(std::span<const HarmonicSum> sums) noexcept;

/// The same sums with preallocated memory, for a thread with a deadline.
class HarmonicSummer {
public:
    /// For spectra of at most `bins` bins. Allocates.
    explicit HarmonicSummer(std::size_t bins);

    /// Returns at most `most` sums, up to `max_sums`; valid until the next call. Wait-free, does not allocate.
    std::span<const HarmonicSum> operator()(const Spectrum& spectrum, double lowest, double highest,
                                            std::size_t most = 5) noexcept;

    static constexpr std::size_t max_sums = 8;

private:
    struct Peak {
        double frequency, salience;  // Hz, 0 … 1
        double power;
    };
    struct Comb {
        double frequency = 0.0;
        double filled = 0.0;  // mean salience of the orders up to the last one there is
        double share = 0.0;   // fraction of lines that are orders, minus the fraction by chance
    };
    static constexpr std::size_t around = 32;  // bins to each side for the noise

    void find_peaks(const Spectrum& spectrum, double lowest, double highest) noexcept;
    const Peak* peak_near(double frequency, double reach) const noexcept;
    Comb comb_of(double total, double frequency, double df, double top) const noexcept;

    std::vector<Peak> peaks_, strongest_;
    std::vector<Comb> combs_;
    std::vector<HarmonicSum> found_;
    std::array<double, 2 * around + 1> noise_{};
    std::array<HarmonicSum, max_sums> best_{};
};

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
// Cross-spectrum, coherence and frequency response of two channels recorded simultaneously.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

#include <complex>

namespace tactus::signal {

/// Averages over segments of conj(X)·Y (scipy's sign), |X|² and |Y|², scaled as `Spectrum` is.
struct CrossSpectra {
    std::vector<double> xx, yy;
    std::vector<std::complex<double>> xy;
    double df = 0.0, noise_bandwidth = 0.0;  ///< Hz
    std::size_t segments = 0;
    double effective_segments = 0.0;

    double frequency(std::size_t bin) const { return static_cast<double>(bin) * df; }
    /// |Pxy|²/(Pxx Pyy), 0 … 1; 0 where a channel is silent. About 1/K for K averages of unrelated noise; throws Error
    /// for fewer than 4 segments, as one segment always gives 1.
    std::vector<double> coherence() const;
    /// H1 = Pxy/Pxx: response from x to y, unbiased by noise in y.
    std::vector<std::complex<double>> h1() const;
    /// H2 = Pyy/conj(Pxy): response from x to y, unbiased by noise in x.
    std::vector<std::complex<double>> h2() const;
    /// Hv = √(H1 H2) with the phase of Pxy: for noise of equal relative power in both channels. The geometric mean, unlike
    /// the total least squares of Rocklin, Crowley and Vold (1985), does not depend on the units.
    std::vector<std::complex<double>> hv() const;
    /// Standard deviation of |H1| relative to it, per bin: √((1−γ²)/(2γ²K)).
    std::vector<double> response_deviation() const;
};

/// Both records must have the same length; averages by the mean (settings.averaging is ignored). Allocates.
/// Throws Error when the lengths differ or the settings are invalid.
template <class T>
CrossSpectra cross_spectra(std::span<const T> x, std::span<const T> y, WelchSettings settings);

/// The same for records that come in pieces, in constant memory.
template <class T>
class CrossStream {
public:
    /// Throws Error when the settings are invalid.
    explicit CrossStream(const WelchSettings& settings);

    /// Equally many samples of each. Does not allocate.
    void push(std::span<const T> x, std::span<const T> y);
    /// Returns the spectra of all samples pushed so far. Allocates.
    CrossSpectra spectra() const;
    /// Marks a gap: no segment spans it.
    void forget_waiting() noexcept;

private:
    void take(std::size_t count);

    struct Sums {
        std::vector<double> xx, yy, re, im;
        explicit Sums(std::size_t bins) : xx(bins), yy(bins), re(bins), im(bins) {}
        void add(Sums& part);
    };
    WelchSettings settings_;
    SegmentFft<T> transform_x_, transform_y_;
    std::vector<T> waiting_x_, waiting_y_;
    std::size_t held_ = 0, segments_ = 0;
    Sums group_, total_;
};

}  // namespace tactus::signal

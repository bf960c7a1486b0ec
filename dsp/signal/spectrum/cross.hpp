// SPDX-License-Identifier: Apache-2.0
// What two channels taken at the same time have in common: cross-spectrum, coherence, response.
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
    /// |Pxy|²/(Pxx Pyy), 0 … 1; 0 where a channel is silent. Of K averages of unrelated noise it is about 1/K; fewer
    /// than 4 segments throw Error, as one segment always gives 1.
    std::vector<double> coherence() const;
    /// Pxy/Pxx: response from x to y when noise is added to y.
    std::vector<std::complex<double>> h1() const;
    /// Pyy/conj(Pxy): response from x to y when noise is added to x.
    std::vector<std::complex<double>> h2() const;
    /// Standard deviation of |H1| relative to it, per bin: √((1−γ²)/(2γ²K)).
    std::vector<double> response_deviation() const;
};

/// Both records must be of one length; only the mean is an average here (settings.averaging is not used). Allocates.
/// Throws Error when the lengths differ or the settings make no sense.
template <class T>
CrossSpectra cross_spectra(std::span<const T> x, std::span<const T> y, WelchSettings settings);

/// The same for records that come in pieces, in memory that does not grow.
template <class T>
class CrossStream {
public:
    /// Throws Error when the settings make no sense.
    explicit CrossStream(const WelchSettings& settings);

    /// As many samples of each. Allocates nothing.
    void push(std::span<const T> x, std::span<const T> y);
    /// Of what was pushed so far. Allocates.
    CrossSpectra spectra() const;

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

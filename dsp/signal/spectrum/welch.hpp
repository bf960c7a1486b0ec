// SPDX-License-Identifier: Apache-2.0
// Power spectra by Welch's method (1967): averages over segments, in the conventions of scipy.signal.welch.
#pragma once

#include "dsp/signal/spectrum/segment_fft.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace tactus::signal {

enum class Averaging {
    mean,
    median,  ///< divided by its bias for noise; robust against a few loud segments
    maximum,  ///< maximum of each bin
    minimum,
};

enum class Scaling {
    density,   ///< unit²/Hz: for noise
    spectrum,  ///< unit²: a tone of amplitude A on a bin reads A²/2
};

struct WelchSettings {
    double rate = 48000.0;  ///< samples per second, Hz
    std::size_t segment = 4096, overlap = 2048;  ///< samples; overlap < segment
    WindowKind window = WindowKind::hann;
    Detrend detrend = Detrend::constant;
    Averaging averaging = Averaging::mean;
    Scaling scaling = Scaling::density;

    static WelchSettings hann(double rate, std::size_t segment, std::size_t overlap) {
        WelchSettings settings;
        settings.rate = rate;
        settings.segment = segment;
        settings.overlap = overlap;
        return settings;
    }

    std::size_t step() const { return segment - overlap; }
    /// Number of whole segments in this many samples; the remainder is dropped.
    std::size_t segments_in(std::size_t samples) const {
        return samples < segment ? 0 : (samples - segment) / step() + 1;
    }
};

/// One-sided: includes the power at negative frequencies, except at 0 Hz and (even segments) at half the rate.
struct Spectrum {
    std::vector<double> power;   ///< per bin, in unit² or unit²/Hz
    double df = 0.0;             ///< Hz between bins; bin k lies at k·df
    double noise_bandwidth = 0;  ///< Hz, equivalent noise bandwidth of the window: power as spectrum / power as density
    std::size_t segments = 0;  ///< number of averaged segments
    /// Number of independent segments with the same variance (accounts for the overlap).
    double effective_segments = 0.0;

    double frequency(std::size_t bin) const { return static_cast<double>(bin) * df; }
    /// Standard deviation of a bin of noise, relative to its power.
    double relative_deviation() const;
};

/// Effective number of segments for `segments` overlapping ones: Welch's variance formula for this window and step.
double effective_segments(std::span<const double> window, std::size_t step, std::size_t segments);

/// scipy's bias correction: median over mean of `segments` powers of noise.
double median_bias(std::size_t segments);

/// The longest power of two within 0.75 s that gives at least eight half-overlapping segments of `frames`, but at least
/// 64; the whole record when it is shorter.
std::size_t suggested_segment(double rate, std::size_t frames);

/// Runs a function for 0 … count−1, in any order or concurrently.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t)>&)>;

/// Spectrum of a record in memory, in double or float. A record shorter than a segment is one segment; an empty one
/// gives no bins. The result does not depend on `for_each`, which may use several threads. Allocates. Throws Error when
/// the settings are invalid.
template <class T>
Spectrum welch(std::span<const T> record, WelchSettings settings, const ForEach& for_each = {});

/// The same for a record that comes in pieces, in constant memory: the median keeps at most `max_median_segments`
/// segments, every 2ᵏth of a long record.
template <class T>
class WelchStream {
public:
    static constexpr std::size_t max_median_segments = 1024;

    /// Throws Error when the settings are invalid.
    explicit WelchStream(const WelchSettings& settings);

    /// Any number of samples. Allocates only for the median.
    void push(std::span<const T> samples);
    /// Marks a gap: no segment spans it.
    void forget_waiting();
    std::size_t segments() const noexcept { return segments_; }
    /// The spectrum of all samples pushed so far. Allocates. Without a whole segment: no bins.
    Spectrum spectrum() const;

private:
    void take(std::size_t count);

    WelchSettings settings_;
    SegmentFft<T> transform_;
    std::vector<T> waiting_;
    std::size_t held_ = 0, segments_ = 0;
    std::vector<double> group_, total_;
    std::vector<std::vector<T>> kept_;
    std::size_t keep_every_ = 1;
};

/// Validates the settings for both forms. Throws Error.
void check(const WelchSettings& settings);

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
// A spectrum that follows what vibrates now: for displays and scores while a patch runs.
#pragma once

#include "dsp/signal/spectrum/fft.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Hann segments, half overlapping, their means taken out, in float. Until `memory` has passed, the spectrum is that of
/// `welch` over all that came; from then on older segments fade with that time constant.
class LiveSpectrum {
public:
    LiveSpectrum() : LiveSpectrum(48000.0, 64, 1.0) {}
    /// `rate` in Hz, `segment` in samples (≥ 4), `memory` in s. Allocates.
    LiveSpectrum(double rate, std::size_t segment, double memory);

    /// Any number of samples; one that is not finite counts as silence. Returns how many segments became whole.
    /// Wait-free, allocates nothing.
    int push(std::span<const float> samples) noexcept;
    /// Density; `segments` says how many came since the start, `effective_segments` how many are still remembered.
    const Spectrum& spectrum() const noexcept { return spectrum_; }

private:
    void take_segment() noexcept;

    RealFft<float> transform_;
    std::vector<float> window_, waiting_, tapered_;
    std::vector<std::complex<float>> bins_;
    std::size_t held_ = 0;
    double scale_ = 0.0, least_share_ = 0.0, independence_ = 1.0;
    Spectrum spectrum_;
};

}  // namespace tactus::signal

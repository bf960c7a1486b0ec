// SPDX-License-Identifier: Apache-2.0
// Running spectrum, for displays and scores while a patch runs.
#pragma once

#include "dsp/signal/spectrum/fft.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Hann segments with 50 % overlap, mean removed, in float. Until `memory` has passed, the spectrum equals that of
/// `welch` over all samples; then older segments decay with that time constant.
class LiveSpectrum {
public:
    LiveSpectrum() : LiveSpectrum(48000.0, 64, 1.0) {}
    /// `rate` in Hz, `segment` in samples (≥ 4), `memory` in s. Allocates.
    LiveSpectrum(double rate, std::size_t segment, double memory);

    /// Any number of samples; a non-finite one counts as 0. Returns the number of completed segments. Wait-free, does
    /// not allocate.
    int push(std::span<const float> samples) noexcept;
    /// Density; `segments` counts all since the start, `effective_segments` those in the average.
    const Spectrum& spectrum() const noexcept { return spectrum_; }

private:
    void take_segment() noexcept;

    RealFft<float> transform_;
    std::vector<float> window_, waiting_, tapered_;
    std::vector<std::complex<float>> bins_;
    std::size_t held_ = 0;
    double scale_ = 0.0, min_share_ = 0.0, independence_ = 1.0;
    Spectrum spectrum_;
};

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
// Envelope of a band (amplitude demodulation): shows the rate of teeth and impacts, which the band's own lines do not.
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <complex>
#include <cstddef>
#include <numbers>

namespace tactus::signal {

/// Shifts the middle of a band to 0 Hz, low-passes at half its width (8th-order Butterworth) and takes the magnitude:
/// the amplitude of the band, at a lower rate.
class BandEnvelope {
public:
    /// Band edges and rate in Hz, 0 < low < high < rate/2. Values come every `step()` samples.
    BandEnvelope(double low, double high, double rate) noexcept
        : step_(static_cast<std::size_t>(std::max(1.0, std::floor(rate / (2.56 * (high - low)))))),
          turn_(std::polar(1.0, -std::numbers::pi * (low + high) / rate)),
          rate_(rate) {
        constexpr double q[] = {0.50979558, 0.60134489, 0.89997622, 2.5629154};
        for (int i = 0; i < 4; ++i) re_[i].coefficients = im_[i].coefficients = lowpass(0.5 * (high - low), rate, q[i]);
    }

    std::size_t step() const noexcept { return step_; }
    double rate() const noexcept { return rate_ / static_cast<double>(step_); }  ///< Hz of the output

    /// Takes a sample; true when `value` is new.
    bool operator()(double x, double& value) noexcept {
        double re = x * phasor_.real(), im = x * phasor_.imag();
        phasor_ *= turn_;
        for (int i = 0; i < 4; ++i) re = re_[i](re), im = im_[i](im);
        if (++count_ < step_) return false;
        count_ = 0;
        phasor_ /= std::abs(phasor_);
        value = 2.0 * std::sqrt(re * re + im * im);
        return true;
    }

private:
    std::size_t step_, count_ = 0;
    std::complex<double> turn_, phasor_ = 1.0;
    double rate_;
    Biquad re_[4], im_[4];
};

}  // namespace tactus::signal

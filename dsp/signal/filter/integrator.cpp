// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/integrator.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/filter/bessel.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::signal {

namespace {

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x); }

}  // namespace

Integrator::Integrator(double high_pass, double rate) : rate_(rate) {
    if (!(high_pass > 0.0 && high_pass < 0.05 * rate))
        throw Error(
            fmt::format("the high-pass of an integration must be above 0 Hz and below a 20th of the sample rate, "
                        "{:g} Hz, not {:g} Hz",
                        0.05 * rate, high_pass));
    double sum = 0.0;
    for (std::size_t i = 0; i < taps; ++i) {
        const double k = static_cast<double>(i) - static_cast<double>(half);
        // The interpolating sinc between k − ½ and k + ½ by Simpson's rule, windowed (Kaiser, β = 6).
        constexpr int pieces = 64;
        double area = 0.0;
        for (int piece = 0; piece <= pieces; ++piece)
            area += (piece == 0 || piece == pieces ? 1.0
                     : piece % 2 == 1              ? 4.0
                                                   : 2.0) *
                    sinc(k - 0.5 + static_cast<double>(piece) / pieces);
        const double place = k / static_cast<double>(half + 1);
        tap_[i] = area / (3.0 * pieces) * bessel_i0(6.0 * std::sqrt(1.0 - place * place));
        sum += tap_[i];
    }
    for (double& tap : tap_) tap /= sum * rate;
    // Of the high-pass with its zeros at z = 1 the integration takes one.
    const BiquadCoefficients c = highpass(high_pass, rate);
    high_pass_.coefficients = {c.b0, -c.b0, 0.0, c.a1, c.a2};
}

double Integrator::operator()(double x) noexcept {
    past_[at_] = x;
    at_ = at_ + 1 == taps ? 0 : at_ + 1;
    double sum = 0.0;
    for (std::size_t i = 0, place = at_; i < taps; ++i, place = place + 1 == taps ? 0 : place + 1)
        sum += tap_[i] * past_[place];
    return high_pass_(sum);
}

std::complex<double> Integrator::response(double frequency) const {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < taps; ++i)
        sum += tap_[i] * std::polar(1.0, -2.0 * pi * frequency / rate_ * static_cast<double>(i));
    return sum * high_pass_.coefficients.response(frequency, rate_);
}

void Integrator::reset() noexcept {
    past_ = {};
    high_pass_.s1 = high_pass_.s2 = 0.0;
}

}  // namespace tactus::signal

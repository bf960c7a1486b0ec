// SPDX-License-Identifier: Apache-2.0
// A biquad for blocks of samples.
#pragma once

#include "dsp/signal/filter/biquad.hpp"
#include "dsp/signal/filter/sample.hpp"

#include <bit>
#include <cstdint>

namespace tactus::signal {

/// Returns true if no sample is infinite or NaN.
inline bool are_finite(const float* samples, int count) noexcept {
    // The top bit of the sum is set if all bits of an exponent are set.
    std::uint32_t any = 0;
    for (int i = 0; i < count; ++i) any |= (std::bit_cast<std::uint32_t>(samples[i]) & 0x7fff'ffffu) + 0x0080'0000u;
    return (any >> 31) == 0;
}

/// One section, y = b0 x + b1 x' + b2 x'' − a1 y' − a2 y'', summed so that y' comes last: the dependency between
/// consecutive samples is then only a product and a difference. New coefficients may be set at any time; the state
/// stays.
struct BlockBiquad {
    BiquadCoefficients coefficients;
    double ahead = 0.0;  ///< b1 x' + b2 x'' − a2 y'' for the next sample
    double further = 0.0;  ///< b2 x' − a2 y' for the one after it
    double last = 0.0;  ///< y'

    double operator()(double x) noexcept {
        const auto& c = coefficients;
        const double y = (c.b0 * x + ahead) - c.a1 * last;
        ahead = c.b1 == 0.0 ? further : c.b1 * x + further;
        further = c.b2 * x - c.a2 * y;
        return last = y;
    }

    /// Gives the bits of to_sample(…(finite_or_zero(in[i]))), but tests the whole block for values that are not finite.
    /// The samples of input and output must not overlap.
    void run(const float* in, float* out, int count) noexcept {
        if (are_finite(in, count)) {
            BlockBiquad section = *this;
            if (coefficients.b1 == 0.0 && coefficients.b2 == -coefficients.b0) section.run_band(in, out, count);
            else
                for (int i = 0; i < count; ++i) out[i] = static_cast<float>(section(static_cast<double>(in[i])));
            if (are_finite(out, count)) {
                *this = section;
                return;
            }
        }
        for (int i = 0; i < count; ++i) out[i] = to_sample((*this)(finite_or_zero(in[i])));
    }

private:
    /// For a band-pass: b1 is 0 and b2 is −b0. The same bits in fewer operations, with the opposite sign of `ahead` and
    /// `further`.
    void run_band(const float* in, float* out, int count) noexcept {
        const double b0 = coefficients.b0, a1 = coefficients.a1, a2 = coefficients.a2;
        double less = -ahead, less_further = -further, y = last;
        for (int i = 0; i < count; ++i) {
            const double driven = b0 * static_cast<double>(in[i]);
            y = (driven - less) - a1 * y;
            less = less_further;
            less_further = driven + a2 * y;
            out[i] = static_cast<float>(y);
        }
        ahead = -less;
        further = -less_further;
        last = y;
    }
};

}  // namespace tactus::signal

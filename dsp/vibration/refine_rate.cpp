// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/refine_rate.hpp"

#include "dsp/signal/filter/biquad.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tactus::vibration {

namespace {

struct Decimated {
    std::vector<double> samples;
    double rate;
};

Decimated decimate(std::span<const float> samples, double rate, double wanted, double cutoff) {
    const auto step = static_cast<std::size_t>(std::max(1.0, std::floor(rate / wanted)));
    Decimated out{{}, rate / static_cast<double>(step)};
    out.samples.reserve(samples.size() / step + 1);
    signal::Biquad first{signal::highpass(30.0, rate)}, second{signal::lowpass(cutoff, rate, 0.541)},
        third{signal::lowpass(cutoff, rate, 1.307)};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double y = third(second(first(samples[i])));
        if (i % step == 0) out.samples.push_back(y);
    }
    return out;
}

/// Sum of the powers of the first `orders` multiples of a frequency, Hz. The lines advance side by side: one line's
/// additions wait for each other, those of several lines do not.
double line_powers(const Decimated& sound, double frequency, int orders) {
    constexpr int side_by_side = 6;
    double power = 0.0;
    for (int first = 1; first <= orders; first += side_by_side) {
        double step_re[side_by_side], step_im[side_by_side], sum_re[side_by_side]{}, sum_im[side_by_side]{};
        double phasor_re[side_by_side], phasor_im[side_by_side]{};
        for (int k = 0; k < side_by_side; ++k) {
            const auto step = std::polar(1.0, -2.0 * std::numbers::pi * ((first + k) * frequency / sound.rate));
            step_re[k] = step.real(), step_im[k] = step.imag(), phasor_re[k] = 1.0;
        }
        for (const double x : sound.samples)
            for (int k = 0; k < side_by_side; ++k) {
                sum_re[k] += x * phasor_re[k];
                sum_im[k] += x * phasor_im[k];
                const double re = phasor_re[k] * step_re[k] - phasor_im[k] * step_im[k];
                phasor_im[k] = phasor_re[k] * step_im[k] + phasor_im[k] * step_re[k];
                phasor_re[k] = re;
            }
        for (int k = 0; k < side_by_side && first + k <= orders; ++k)
            power += sum_re[k] * sum_re[k] + sum_im[k] * sum_im[k];
    }
    return power;
}

}  // namespace

double refine_rate(std::span<const float> samples, double sample_rate, double rate, double range, int orders) {
    if (!(static_cast<double>(samples.size()) * rate / sample_rate >= 8.0)) return rate;
    Decimated low = decimate(samples, sample_rate, 6000.0, std::min(1500.0, 0.4 * sample_rate));
    const auto count = static_cast<double>(low.samples.size());
    for (std::size_t i = 0; i < low.samples.size(); ++i)
        low.samples[i] *= 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / count);
    const auto together = [&](double f) {
        int within = 0;
        while (within < orders && (within + 1) * f < 0.3 * low.rate) ++within;
        return line_powers(low, f, within);
    };
    // The main lobe of the highest order is 4/(duration × orders) wide: search with a quarter of it, then refine.
    const double step = low.rate / count / orders;
    const int reach = std::clamp(static_cast<int>(range * rate / step), 1, 400);
    const double stride = std::max(step, range * rate / reach);
    double centre = rate, best = together(rate);
    for (int i = -reach; i <= reach; ++i) {
        const double f = rate + i * stride, power = together(f);
        if (power > best) best = power, centre = f;
    }
    double a = centre - stride, b = centre + stride;
    for (int i = 0; i < 24; ++i) {
        const double left = a + (b - a) / 3.0, right = b - (b - a) / 3.0;
        if (together(left) < together(right)) a = left;
        else b = right;
    }
    return 0.5 * (a + b);
}

}  // namespace tactus::vibration

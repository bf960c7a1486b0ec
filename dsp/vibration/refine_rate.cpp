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

double line_power(std::span<const double> samples, double cycles_per_sample) {
    const std::complex<double> step = std::polar(1.0, -2.0 * std::numbers::pi * cycles_per_sample);
    std::complex<double> phasor = 1.0, sum = 0.0;
    for (double x : samples) {
        sum += x * phasor;
        phasor *= step;
    }
    return std::norm(sum);
}

}  // namespace

double refine_rate(std::span<const float> samples, double sample_rate, double rate, double range, int orders) {
    if (!(static_cast<double>(samples.size()) * rate / sample_rate >= 8.0)) return rate;
    Decimated low = decimate(samples, sample_rate, 6000.0, std::min(1500.0, 0.4 * sample_rate));
    const auto count = static_cast<double>(low.samples.size());
    for (std::size_t i = 0; i < low.samples.size(); ++i)
        low.samples[i] *= 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / count);
    const auto together = [&](double f) {
        double sum = 0.0;
        for (int k = 1; k <= orders && k * f < 0.3 * low.rate; ++k) sum += line_power(low.samples, k * f / low.rate);
        return sum;
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

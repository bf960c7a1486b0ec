// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/cycle_loop.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/vibration/sinc_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::vibration {

namespace {

/// The low-passed sound at a position (in samples); `cutoff` 1 is half the sample rate.
double read_filtered(std::span<const float> samples, const SincKernel& kernel, double position, double cutoff) {
    const double reach = kernel.half / cutoff;
    const auto count = static_cast<std::ptrdiff_t>(samples.size());
    const auto first = std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(std::ceil(position - reach)));
    const auto last = std::min<std::ptrdiff_t>(count - 1, static_cast<std::ptrdiff_t>(std::floor(position + reach)));
    double sum = 0.0;
    for (std::ptrdiff_t i = first; i <= last; ++i)
        sum += samples[static_cast<std::size_t>(i)] * kernel((static_cast<double>(i) - position) * cutoff);
    return sum * cutoff;
}

double correlation(std::span<const float> samples, std::size_t a, std::size_t b, std::size_t count) {
    double product = 0.0, power_a = 0.0, power_b = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = samples[a + i], y = samples[b + i];
        product += x * y, power_a += x * x, power_b += y * y;
    }
    const double scale = std::sqrt(power_a * power_b);
    return scale > 0.0 ? product / scale : 0.0;
}

}  // namespace

double fade_gain(double x, double power_a, double power_b, double correlation_ab) {
    const double a = 1.0 - x, b = x;
    const double wanted = a * power_a + b * power_b;
    const double got = a * a * power_a + b * b * power_b + 2.0 * a * b * correlation_ab * std::sqrt(power_a * power_b);
    return got > 0.0 ? std::sqrt(wanted / got) : 1.0;
}

CycleLoop::CycleLoop(std::span<const float> samples, double sample_rate, double reciprocation_rate,
                     double output_rate) {
    const double period = sample_rate / reciprocation_rate;
    const auto available = std::min(static_cast<double>(samples.size()), longest * sample_rate);
    const auto all_cycles = static_cast<std::size_t>(available / period);
    if (all_cycles < fewest_cycles)
        throw Error(fmt::format("a recording of {:.3g} s holds only {} cycles at {:.4g} Hz; {} are needed",
                                static_cast<double>(samples.size()) / sample_rate, all_cycles, reciprocation_rate,
                                fewest_cycles));
    const std::size_t fade_cycles = std::max<std::size_t>(1, std::min<std::size_t>(all_cycles / 4, 8));
    const auto fade_in = static_cast<std::size_t>(static_cast<double>(fade_cycles) * period);
    const std::size_t most = all_cycles - fade_cycles, least = std::max<std::size_t>(2, most * 9 / 10);
    double best = -2.0;
    for (std::size_t n = most; n >= least; --n) {
        const auto end = static_cast<std::size_t>(static_cast<double>(n) * period + 0.5);
        if (end + fade_in > samples.size()) continue;
        const double alike = correlation(samples, 0, end, fade_in);
        if (alike > best + 1e-3) best = alike, cycles_ = n;
    }
    // The loop itself begins after the lead-in of fade_cycles, into which its end is cross-faded.
    const double length = static_cast<double>(cycles_) * period;
    count_ = static_cast<std::size_t>(std::llround(length * output_rate / sample_rate));
    samples_per_cycle_ = static_cast<double>(count_) / static_cast<double>(cycles_);
    const double step = length / static_cast<double>(count_), lead = static_cast<double>(fade_cycles) * period;
    const double cutoff = std::min(0.96, 0.84 * output_rate / sample_rate);
    const SincKernel kernel{24};
    const auto fade = static_cast<std::size_t>(lead / step);
    std::vector<double> loop(count_), before(fade);
    for (std::size_t i = 0; i < count_; ++i)
        loop[i] = read_filtered(samples, kernel, lead + static_cast<double>(i) * step, cutoff);
    for (std::size_t i = 0; i < fade; ++i)
        before[i] = read_filtered(samples, kernel, lead - static_cast<double>(fade - i) * step, cutoff);
    double power_end = 0.0, power_before = 0.0;
    for (std::size_t i = 0; i < fade; ++i) {
        power_end += loop[count_ - fade + i] * loop[count_ - fade + i];
        power_before += before[i] * before[i];
    }
    for (std::size_t i = 0; i < fade; ++i) {
        const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(fade);
        double& y = loop[count_ - fade + i];
        y = fade_gain(x, power_end, power_before, std::max(best, -0.5)) * ((1.0 - x) * y + x * before[i]);
    }
    for (double y : loop) power_ += y * y / static_cast<double>(count_);
    for (int k = 1; k <= orders; ++k) {
        const double turn = -2.0 * pi * k / samples_per_cycle_;
        if (-turn > pi) break;
        std::complex<double> sum = 0.0;
        for (std::size_t i = 0; i < count_; ++i) sum += loop[i] * std::polar(1.0, turn * static_cast<double>(i));
        harmonics_[static_cast<std::size_t>(k - 1)] = sum / static_cast<double>(count_);
    }
    const std::size_t guard = reading_half;
    samples_.resize(count_ + 2 * guard);
    for (std::size_t i = 0; i < samples_.size(); ++i)
        samples_[i] = static_cast<float>(loop[(i + count_ - guard) % count_]);
}

double CycleLoop::operator()(double cycles) const noexcept {
    const double turned = (cycles + offset_) / static_cast<double>(cycles_);
    const double part = turned - static_cast<double>(static_cast<std::int64_t>(turned));
    const double position = std::min(part * static_cast<double>(count_), static_cast<double>(count_));
    const auto whole = std::min(static_cast<std::size_t>(position), count_ - 1);
    const double x = position - static_cast<double>(whole);
    // The guard shifts the samples by reading_half: these are the 16 around the position.
    return read_between(samples_.data() + whole + 1, x);
}

void CycleLoop::align(const CycleLoop& reference) {
    const auto agreement = [&](double shift) {
        double sum = 0.0;
        for (std::size_t k = 0; k < orders; ++k)
            sum += std::real(harmonics_[k] * std::polar(1.0, 2.0 * pi * static_cast<double>(k + 1) * shift) *
                             std::conj(reference.harmonics_[k]));
        return sum;
    };
    constexpr int places = 1024;
    int best = 0;
    for (int i = 1; i < places; ++i)
        if (agreement(i / double{places}) > agreement(best / double{places})) best = i;
    const double shift = best / double{places};
    offset_ = std::fmod(offset_ + shift, 1.0);
    for (std::size_t k = 0; k < orders; ++k)
        harmonics_[k] *= std::polar(1.0, 2.0 * pi * static_cast<double>(k + 1) * shift);
}

double likeness(const CycleLoop& a, const CycleLoop& b) {
    double product = 0.0;
    for (std::size_t k = 0; k < CycleLoop::orders; ++k)
        product += 2.0 * std::real(a.harmonics_[k] * std::conj(b.harmonics_[k]));
    const double scale = std::sqrt(a.power_ * b.power_);
    return scale > 0.0 ? std::clamp(product / scale, -0.5, 1.0) : 0.0;
}

}  // namespace tactus::vibration

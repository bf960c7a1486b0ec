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
#include <utility>

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

/// A loop through a low-pass; `cutoff` 1 is half of its sample rate. `shift`: samples, of the positions that are read.
std::vector<double> filter_loop(const std::vector<double>& loop, int crossings, double cutoff, double shift) {
    const SincKernel kernel(crossings);
    const auto count = static_cast<std::ptrdiff_t>(loop.size());
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(crossings / cutoff)) + 1;
    std::vector<double> taps, padded, out(loop.size());
    for (std::ptrdiff_t i = -reach; i <= reach; ++i)
        taps.push_back(cutoff * kernel((static_cast<double>(i) - shift) * cutoff));
    for (std::ptrdiff_t i = -reach; i < count + reach; ++i)
        padded.push_back(loop[static_cast<std::size_t>(((i % count) + count) % count)]);
    for (std::size_t i = 0; i < out.size(); ++i) {
        double sum = 0.0;
        for (std::size_t k = 0; k < taps.size(); ++k) sum += taps[k] * padded[i + k];
        out[i] = sum;
    }
    return out;
}

constexpr double bandwidth = 0.42;  // of the output rate
// A version plays alone up to `full` times its highest ratio without aliasing; up to `faded` it gives way to the next.
constexpr double full = 1.05, faded = 1.15;
static_assert(bandwidth * faded < 0.5);
constexpr double greatest_makeup = 10.0;

}  // namespace

double fade_gain(double x, double power_a, double power_b, double correlation_ab) {
    const double a = 1.0 - x, b = x;
    const double wanted = a * power_a + b * power_b;
    const double got = a * a * power_a + b * b * power_b + 2.0 * a * b * correlation_ab * std::sqrt(power_a * power_b);
    return got > 0.0 ? std::sqrt(wanted / got) : 1.0;
}

CycleLoop::CycleLoop(std::span<const float> samples, double sample_rate, double reciprocation_rate, double output_rate,
                     double max_ratio) {
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
    const auto count = static_cast<std::size_t>(std::llround(length * output_rate / sample_rate));
    samples_per_cycle_ = static_cast<double>(count) / static_cast<double>(cycles_);
    const double step = length / static_cast<double>(count), lead = static_cast<double>(fade_cycles) * period;
    const double cutoff = std::min(0.96, 2.0 * bandwidth * output_rate / sample_rate);
    const SincKernel kernel{24};
    const auto fade = static_cast<std::size_t>(lead / step);
    std::vector<double> loop(count), before(fade);
    for (std::size_t i = 0; i < count; ++i)
        loop[i] = read_filtered(samples, kernel, lead + static_cast<double>(i) * step, cutoff);
    for (std::size_t i = 0; i < fade; ++i)
        before[i] = read_filtered(samples, kernel, lead - static_cast<double>(fade - i) * step, cutoff);
    double power_end = 0.0, power_before = 0.0;
    for (std::size_t i = 0; i < fade; ++i) {
        power_end += loop[count - fade + i] * loop[count - fade + i];
        power_before += before[i] * before[i];
    }
    for (std::size_t i = 0; i < fade; ++i) {
        const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(fade);
        double& y = loop[count - fade + i];
        y = fade_gain(x, power_end, power_before, std::max(best, -0.5)) * ((1.0 - x) * y + x * before[i]);
    }
    for (double y : loop) power_ += y * y / static_cast<double>(count);
    for (int k = 1; k <= orders; ++k) {
        const double turn = -2.0 * pi * k / samples_per_cycle_;
        if (-turn > pi) break;
        std::complex<double> sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) sum += loop[i] * std::polar(1.0, turn * static_cast<double>(i));
        harmonics_[static_cast<std::size_t>(k - 1)] = sum / static_cast<double>(count);
    }
    // Twice the rate: the samples and, between them, what a half-band filter finds there.
    const std::vector<double> between = filter_loop(loop, 24, 1.0, 0.5);
    std::vector<double> fine(2 * count);
    for (std::size_t i = 0; i < count; ++i) {
        fine[2 * i] = loop[i];
        fine[2 * i + 1] = between[i];
    }
    add_version(fine);
    constexpr int crossings = 12;
    constexpr double stop = 1.0 + 3.0 / crossings;  // end of the transition over its middle, Blackman window
    for (double highest = 2.0; 0.5 * highest * full < max_ratio; highest *= 2.0)
        add_version(filter_loop(loop, crossings, 2.0 * bandwidth / highest / stop, 0.0));
}

void CycleLoop::add_version(const std::vector<double>& loop) {
    Version version;
    version.count = loop.size();
    for (const double y : loop) version.power += y * y / static_cast<double>(loop.size());
    const std::size_t guard = reading_half;
    version.samples.resize(version.count + 2 * guard);
    for (std::size_t i = 0; i < version.samples.size(); ++i)
        version.samples[i] = static_cast<float>(loop[(i + version.count * guard - guard) % version.count]);
    versions_.push_back(std::move(version));
}

double CycleLoop::read(const Version& version, double part) const noexcept {
    const auto count = static_cast<double>(version.count);
    const double position = std::min(part * count, count);
    const auto whole = std::min(static_cast<std::size_t>(position), version.count - 1);
    // The guard shifts the samples by reading_half: these are the 16 around the position.
    return read_between(version.samples.data() + whole + 1, position - static_cast<double>(whole));
}

double CycleLoop::operator()(double cycles, double ratio) const noexcept {
    const double turned = (cycles + offset_) / static_cast<double>(cycles_);
    const double part = turned - static_cast<double>(static_cast<std::int64_t>(turned));
    std::size_t at = 0;
    double highest = 1.0;
    while (at + 1 < versions_.size() && ratio >= faded * highest) ++at, highest *= 2.0;
    const Version& wide = versions_[at];
    const double x = at + 1 < versions_.size() ? (ratio / highest - full) / (faded - full) : 0.0;
    double value = read(wide, part), power = wide.power;
    if (x > 0.0) {
        const Version& narrow = versions_[at + 1];
        value += x * (read(narrow, part) - value);
        // The wide version is the narrow one and what lies above its band.
        power = narrow.power + (1.0 - x) * (1.0 - x) * (wide.power - narrow.power);
    } else if (at == 0) {
        return value;
    }
    return power > 0.0 ? value * std::min(std::sqrt(power_ / power), greatest_makeup) : 0.0;
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

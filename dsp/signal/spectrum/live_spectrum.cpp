// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/live_spectrum.hpp"

#include "dsp/signal/filter/one_pole.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "dsp/signal/spectrum/window.hpp"

#include <algorithm>

namespace tactus::signal {

namespace {

constexpr double loudest = 1e12;  // the power of a segment would overflow a float above it

}  // namespace

LiveSpectrum::LiveSpectrum(double rate, std::size_t segment, double memory)
    : transform_(segment), waiting_(segment), tapered_(segment), bins_(transform_.bins()) {
    const std::vector<double> window = make_window(WindowKind::hann, segment);
    double squares = 0.0, sum = 0.0;
    for (const double w : window) {
        window_.push_back(static_cast<float>(w));
        squares += w * w;
        sum += w;
    }
    const std::size_t step = segment - segment / 2;
    scale_ = 1.0 / (rate * squares);
    min_share_ = lag_share(memory, static_cast<double>(step) / rate);
    independence_ = tactus::signal::effective_segments(window, step, 64) / 64.0;
    spectrum_.power.assign(transform_.bins(), 0.0);
    spectrum_.df = rate / static_cast<double>(segment);
    spectrum_.noise_bandwidth = rate * squares / (sum * sum);
}

int LiveSpectrum::push(std::span<const float> samples) noexcept {
    int whole = 0;
    while (!samples.empty()) {
        const std::size_t part = std::min(samples.size(), waiting_.size() - held_);
        for (std::size_t i = 0; i < part; ++i)
            waiting_[held_ + i] = static_cast<float>(std::clamp(finite_or_zero(samples[i]), -loudest, loudest));
        held_ += part;
        samples = samples.subspan(part);
        if (held_ < waiting_.size()) break;
        take_segment();
        ++whole;
        const std::size_t kept = waiting_.size() / 2;
        std::copy(waiting_.end() - static_cast<std::ptrdiff_t>(kept), waiting_.end(), waiting_.begin());
        held_ = kept;
    }
    return whole;
}

void LiveSpectrum::take_segment() noexcept {
    double mean = 0.0;
    for (const float x : waiting_) mean += static_cast<double>(x);
    mean /= static_cast<double>(waiting_.size());
    for (std::size_t i = 0; i < waiting_.size(); ++i)
        tapered_[i] = static_cast<float>(static_cast<double>(waiting_[i]) - mean) * window_[i];
    transform_.forward(tapered_, bins_);
    ++spectrum_.segments;
    const double share = std::max(min_share_, 1.0 / static_cast<double>(spectrum_.segments));
    const std::size_t last = bins_.size() - 1;
    const bool even = waiting_.size() % 2 == 0;
    for (std::size_t k = 0; k <= last; ++k) {
        const double re = static_cast<double>(bins_[k].real()), im = static_cast<double>(bins_[k].imag());
        const double sides = k == 0 || (k == last && even) ? 1.0 : 2.0;
        spectrum_.power[k] += share * (sides * scale_ * (re * re + im * im) - spectrum_.power[k]);
    }
    // An exponential average with share α has the variance of 2/α − 1 equal segments.
    spectrum_.effective_segments = independence_ * std::min(static_cast<double>(spectrum_.segments), 2.0 / share - 1.0);
}

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/spectrogram.hpp"

#include <algorithm>
#include <array>

namespace tactus::signal {

Spectrogram::Spectrogram(std::size_t segment, double rate)
    : transform_(segment, WindowKind::hann, Detrend::constant),
      rate_(rate),
      df_(rate / static_cast<double>(segment)),
      step_(std::max<std::size_t>(1, segment / 2)),
      waiting_(segment + (SegmentFft<double>::lanes - 1) * step_),
      sum_(transform_.bins()) {
    double squares = 0.0;
    for (const double w : transform_.window()) squares += w * w;
    scale_ = 2.0 / (rate * squares);
}

double Spectrogram::column_seconds() const noexcept { return static_cast<double>(step_ * per_column_) / rate_; }

void Spectrogram::push(std::span<const double> samples) {
    constexpr std::size_t lanes = SegmentFft<double>::lanes;
    while (!samples.empty()) {
        const std::size_t part = std::min(samples.size(), waiting_.size() - held_);
        std::copy_n(samples.begin(), part, waiting_.begin() + static_cast<std::ptrdiff_t>(held_));
        held_ += part;
        samples = samples.subspan(part);
        if (held_ < waiting_.size()) return;
        std::array<const double*, lanes> starts;
        for (std::size_t i = 0; i < lanes; ++i) starts[i] = waiting_.data() + i * step_;
        const Lanes<double>* spectrum = transform_(starts);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            for (std::size_t k = 0; k < sum_.size(); ++k) {
                const double re = spectrum[2 * k][lane], im = spectrum[2 * k + 1][lane];
                sum_[k] += scale_ * (re * re + im * im);
            }
            if (++in_column_ >= per_column_) add_column();
        }
        std::copy(waiting_.begin() + static_cast<std::ptrdiff_t>(lanes * step_), waiting_.end(), waiting_.begin());
        held_ -= lanes * step_;
    }
}

void Spectrogram::add_column() {
    std::vector<float> column(sum_.size());
    for (std::size_t k = 0; k < sum_.size(); ++k)
        column[k] = static_cast<float>(sum_[k] / static_cast<double>(in_column_));
    std::fill(sum_.begin(), sum_.end(), 0.0);
    in_column_ = 0;
    columns_.push_back(std::move(column));
    if (columns_.size() < max_columns) return;
    for (std::size_t i = 0; 2 * i + 1 < columns_.size(); ++i) {
        for (std::size_t k = 0; k < sum_.size(); ++k)
            columns_[i][k] = 0.5F * (columns_[2 * i][k] + columns_[2 * i + 1][k]);
    }
    columns_.resize(columns_.size() / 2);
    per_column_ *= 2;
}

}  // namespace tactus::signal

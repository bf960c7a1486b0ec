// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/weighting.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::signal {

namespace {

std::complex<double> s_of(double frequency) { return {0.0, 2.0 * pi * frequency}; }

// The factors of a weighting.
std::complex<double> band_low(const Weighting& w, double f) {
    const auto s = s_of(f), w1 = std::complex<double>(2.0 * pi * w.low);
    return s * s / (s * s + w1 / butterworth_q * s + w1 * w1);
}
std::complex<double> band_high(const Weighting& w, double f) {
    const auto s = s_of(f), w2 = std::complex<double>(2.0 * pi * w.high);
    return w2 * w2 / (s * s + w2 / butterworth_q * s + w2 * w2);
}
std::complex<double> velocity(const Weighting& w, double f) {
    const auto s = s_of(f), w3 = std::complex<double>(2.0 * pi * w.transition);
    return w.gain * (w3 * w3 + w3 * s) / (s * s + w3 / w.transition_q * s + w3 * w3);
}
std::complex<double> step_up(const Weighting& w, double f) {
    if (!w.has_step()) return 1.0;
    const auto s = s_of(f), w5 = std::complex<double>(2.0 * pi * w.step_zero),
               w6 = std::complex<double>(2.0 * pi * w.step_pole);
    return (s * s + w5 / w.step_zero_q * s + w5 * w5) / (s * s + w6 / w.step_pole_q * s + w6 * w6);
}

/// (s² + b1 s + b0) / (s² + a1 s + a0) by the bilinear transform, s = 2 rate (1 − z⁻¹)/(1 + z⁻¹): for corners far below
/// the rate.
BiquadCoefficients bilinear(double b1, double b0, double a1, double a0, double rate) {
    const double k = 2.0 * rate, kk = k * k, scale = 1.0 / (kk + a1 * k + a0);
    return {scale * (kk + b1 * k + b0), scale * 2.0 * (b0 - kk), scale * (kk - b1 * k + b0), scale * 2.0 * (a0 - kk),
            scale * (kk - a1 * k + a0)};
}

BiquadCoefficients bilinear_high_pass(const Weighting& w, double rate) {
    const double w1 = 2.0 * pi * w.low;
    return bilinear(0.0, 0.0, w1 / butterworth_q, w1 * w1, rate);
}

BiquadCoefficients bilinear_step(const Weighting& w, double rate) {
    if (!w.has_step()) return {};
    const double w5 = 2.0 * pi * w.step_zero, w6 = 2.0 * pi * w.step_pole;
    return bilinear(w5 / w.step_zero_q, w5 * w5, w6 / w.step_pole_q, w6 * w6, rate);
}

/// A section with the poles of the analogue one (impulse invariance) and its gain at 0 Hz, at `middle` and at half the
/// rate, which the bilinear transform would pull to 0 (Vicanek 2016, matched second-order filters).
template <class Factor>
BiquadCoefficients matched(const Factor& weight, double w0, double q, double rate, double middle) {
    const double x = w0 / rate, damping = 0.5 / q;
    const double a1 = -2.0 * std::exp(-damping * x) * std::cos(std::sqrt(1.0 - damping * damping) * x);
    const double a2 = std::exp(-2.0 * damping * x);
    const double low = std::norm(weight(0.0)) * (1.0 + a1 + a2) * (1.0 + a1 + a2);
    const double high = std::norm(weight(0.5 * rate)) * (1.0 - a1 + a2) * (1.0 - a1 + a2);
    const double p1 = std::pow(std::sin(pi * middle / rate), 2), p0 = 1.0 - p1, p2 = 4.0 * p0 * p1;
    const double poles =
        (1.0 + a1 + a2) * (1.0 + a1 + a2) * p0 + (1.0 - a1 + a2) * (1.0 - a1 + a2) * p1 - 4.0 * a2 * p2;
    const double bend = (poles * std::norm(weight(middle)) - low * p0 - high * p1) / p2;
    const double sum = 0.5 * (std::sqrt(low) + std::sqrt(high));
    const double b0 = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum + bend)));
    return {b0, 0.5 * (std::sqrt(low) - std::sqrt(high)), -bend / (4.0 * b0), a1, a2};
}

}  // namespace

std::complex<double> Weighting::operator()(double frequency) const {
    return band_low(*this, frequency) * band_high(*this, frequency) * velocity(*this, frequency) *
           step_up(*this, frequency);
}

WeightingFilter::WeightingFilter(const Weighting& weighting, double rate) : rate_(rate) {
    if (!(rate > 0.0)) throw Error("a frequency weighting needs a sampling rate above 0 Hz");
    sections_[0].coefficients = bilinear_high_pass(weighting, rate);
    sections_[1].coefficients = matched([&](double f) { return band_high(weighting, f); }, 2.0 * pi * weighting.high,
                                        butterworth_q, rate, std::min(weighting.high, 0.4 * rate));
    sections_[2].coefficients =
        matched([&](double f) { return velocity(weighting, f); }, 2.0 * pi * weighting.transition,
                weighting.transition_q, rate, std::min(0.8 * weighting.high, 0.125 * rate));
    sections_[3].coefficients = bilinear_step(weighting, rate);
}

std::complex<double> WeightingFilter::response(double frequency) const {
    std::complex<double> product = 1.0;
    for (const Biquad& section : sections_) product *= section.coefficients.response(frequency, rate_);
    return product;
}

WeightedRecord::WeightedRecord(const Weighting& weighting, double rate, double mean)
    : weighting_(weighting),
      rate_(rate),
      mean_(mean),
      filter_(weighting, rate),
      second_(static_cast<std::size_t>(std::max(1.0, std::round(rate)))) {}

void WeightedRecord::filter(double x) {
    const double y = filter_(x), square = y * y;
    filtered_ += square;
    fourth_ += square * square;
    peak_ = std::max(peak_, std::abs(y));
    double& oldest = second_[filtered_in_piece_ % second_.size()];
    running_ += square - oldest;
    oldest = square;
    if (++filtered_in_piece_ >= second_.size())
        max_running_ = std::max(max_running_, std::sqrt(std::max(0.0, running_) / static_cast<double>(second_.size())));
}

void WeightedRecord::push(std::span<const double> samples) {
    for (const double x : samples) {
        held_.push_back(x - mean_);
        filter(x - mean_);
        if (++in_piece_; held_.size() == longest_block) transform();
    }
    count_ += samples.size();
}

void WeightedRecord::end_piece() {
    if (in_piece_ == 0) return;
    if (in_piece_ < second_.size())
        max_running_ = std::max(max_running_, std::sqrt(running_ / static_cast<double>(in_piece_)));
    // The filter rings on after the end: the transform contains that, too.
    for (std::size_t i = 0; i < tail(); ++i) filter(0.0);
    filter_ = WeightingFilter(weighting_, rate_);
    std::ranges::fill(second_, 0.0);
    running_ = 0.0;
    filtered_in_piece_ = 0;
    transform();
    in_piece_ = 0;
}

/// The high-pass decays by 97 dB: half a second of Wh.
std::size_t WeightedRecord::tail() const { return static_cast<std::size_t>(3.2 / weighting_.low * rate_); }

void WeightedRecord::transform() {
    if (held_.empty()) return;
    const std::size_t size = std::bit_ceil(held_.size() + tail());
    const std::vector<std::complex<double>> spectrum = spectrum_of(held_, size);
    double sum = 0.0;
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
        const double both_sides = 2 * k == size ? 1.0 : 2.0;
        sum += both_sides * std::norm(spectrum[k]) *
               std::norm(weighting_(rate_ * static_cast<double>(k) / static_cast<double>(size)));
    }
    transformed_ += sum / static_cast<double>(size);
    held_.clear();
}

double WeightedRecord::by_transform() const {
    return std::sqrt(transformed_ / static_cast<double>(std::max<std::size_t>(1, count_)));
}

double WeightedRecord::by_filter() const {
    return std::sqrt(filtered_ / static_cast<double>(std::max<std::size_t>(1, count_)));
}

double WeightedRecord::dose() const { return std::sqrt(std::sqrt(fourth_ / rate_)); }

}  // namespace tactus::signal

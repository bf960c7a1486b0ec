// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/hand_arm.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::signal {

namespace {

// ISO 8041-1, table 3: 10^0.8 and 10^3.1 Hz, 100/2π Hz.
const double w1 = 2.0 * pi * std::pow(10.0, 0.8), w2 = 2.0 * pi * std::pow(10.0, 3.1);
constexpr double w3 = 100.0, q1 = std::numbers::sqrt2 / 2.0, q4 = 0.64;

using Weight = std::complex<double> (*)(double frequency);

std::complex<double> s_of(double frequency) { return {0.0, 2.0 * pi * frequency}; }

// The three factors of the weighting.
std::complex<double> band_low(double f) {
    const auto s = s_of(f);
    return s * s / (s * s + w1 / q1 * s + w1 * w1);
}
std::complex<double> band_high(double f) {
    const auto s = s_of(f);
    return w2 * w2 / (s * s + w2 / q1 * s + w2 * w2);
}
std::complex<double> velocity(double f) {
    const auto s = s_of(f);
    return (w3 * w3 + w3 * s) / (s * s + w3 / q4 * s + w3 * w3);
}

/// The high-pass by the bilinear transform, s = 2 rate (1 − z⁻¹)/(1 + z⁻¹): its corner is far below the rate.
BiquadCoefficients bilinear_high_pass(double rate) {
    const double k = 2.0 * rate, kk = k * k, a0 = w1 * w1 + w1 / q1 * k + kk;
    return {kk / a0, -2.0 * kk / a0, kk / a0, 2.0 * (w1 * w1 - kk) / a0, (w1 * w1 - w1 / q1 * k + kk) / a0};
}

/// A section with the poles of the analogue one (impulse invariance) and its gain at 0 Hz, at `middle` and at half the
/// rate, which the bilinear transform would pull to 0 (Vicanek 2016, matched second-order filters).
BiquadCoefficients matched(Weight weight, double w0, double q, double rate, double middle) {
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

std::complex<double> hand_arm_weighting(double frequency) {
    return band_low(frequency) * band_high(frequency) * velocity(frequency);
}

HandArmFilter::HandArmFilter(double rate) : rate_(rate) {
    if (!(rate > 0.0)) throw Error("the hand-arm weighting needs a sampling rate above 0 Hz");
    sections_[0].coefficients = bilinear_high_pass(rate);
    sections_[1].coefficients = matched(band_high, w2, q1, rate, std::min(0.5 * w2 / pi, 0.4 * rate));
    sections_[2].coefficients = matched(velocity, w3, q4, rate, std::min(1000.0, 0.125 * rate));
}

std::complex<double> HandArmFilter::response(double frequency) const {
    std::complex<double> product = 1.0;
    for (const Biquad& section : sections_) product *= section.coefficients.response(frequency, rate_);
    return product;
}

WeightedRecord::WeightedRecord(double rate, double mean) : rate_(rate), mean_(mean), filter_(rate) {}

void WeightedRecord::push(std::span<const double> samples) {
    for (const double x : samples) {
        held_.push_back(x - mean_);
        const double y = filter_(x - mean_);
        filtered_ += y * y;
        if (++in_piece_; held_.size() == longest_block) transform();
    }
    count_ += samples.size();
}

void WeightedRecord::end_piece() {
    if (in_piece_ == 0) return;
    // The filter rings on after the end: the transform contains that, too.
    for (std::size_t i = 0; i < tail(); ++i) {
        const double y = filter_(0.0);
        filtered_ += y * y;
    }
    filter_ = HandArmFilter(rate_);
    transform();
    in_piece_ = 0;
}

std::size_t WeightedRecord::tail() const { return static_cast<std::size_t>(0.5 * rate_); }

void WeightedRecord::transform() {
    if (held_.empty()) return;
    const std::size_t size = std::bit_ceil(held_.size() + tail());
    const std::vector<std::complex<double>> spectrum = spectrum_of(held_, size);
    double sum = 0.0;
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
        const double both_sides = 2 * k == size ? 1.0 : 2.0;
        sum += both_sides * std::norm(spectrum[k]) *
               std::norm(hand_arm_weighting(rate_ * static_cast<double>(k) / static_cast<double>(size)));
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

double vibration_total(std::span<const double> axes) {
    double sum = 0.0;
    for (const double a : axes) sum += a * a;
    return std::sqrt(sum);
}

double daily_exposure(std::span<const HandArmOperation> operations) {
    double sum = 0.0;
    for (const HandArmOperation& one : operations) sum += one.acceleration * one.acceleration * one.duration;
    return std::sqrt(sum / reference_day);
}

double time_to_reach(double value, double acceleration) {
    if (!(acceleration > 0.0)) return std::numeric_limits<double>::infinity();
    return reference_day * value * value / (acceleration * acceleration);
}

double years_to_white_fingers(double a8) { return 31.8 * std::pow(a8, -1.06); }

}  // namespace tactus::signal

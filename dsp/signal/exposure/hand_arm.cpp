// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/exposure/hand_arm.hpp"

#include "dsp/core/error.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::signal {

namespace {

constexpr double pi = std::numbers::pi;
// ISO 8041-1, table 3: 10^0.8 and 10^3.1 Hz, 100/2π Hz.
const double w1 = 2.0 * pi * std::pow(10.0, 0.8), w2 = 2.0 * pi * std::pow(10.0, 3.1);
constexpr double w3 = 100.0, q1 = std::numbers::sqrt2 / 2.0, q4 = 0.64;

/// (n0 + n1 s + n2 s²)/(d0 + d1 s + d2 s²) with s = 2 rate (1 − z⁻¹)/(1 + z⁻¹).
BiquadCoefficients bilinear(double n0, double n1, double n2, double d0, double d1, double d2, double rate) {
    const double k = 2.0 * rate, kk = k * k;
    const double a0 = d0 + d1 * k + d2 * kk;
    return {(n0 + n1 * k + n2 * kk) / a0, 2.0 * (n0 - n2 * kk) / a0, (n0 - n1 * k + n2 * kk) / a0,
            2.0 * (d0 - d2 * kk) / a0, (d0 - d1 * k + d2 * kk) / a0};
}

}  // namespace

std::complex<double> hand_arm_weighting(double frequency) {
    const std::complex<double> s(0.0, 2.0 * pi * frequency);
    const auto high = s * s / (s * s + w1 / q1 * s + w1 * w1);
    const auto low = w2 * w2 / (s * s + w2 / q1 * s + w2 * w2);
    const auto velocity = (w3 * w3 + w3 * s) / (s * s + w3 / q4 * s + w3 * w3);
    return high * low * velocity;
}

HandArmFilter::HandArmFilter(double rate) : rate_(rate) {
    if (!(rate > 0.0)) throw Error("the hand-arm weighting needs a sampling rate above 0 Hz");
    sections_[0].coefficients = bilinear(0.0, 0.0, 1.0, w1 * w1, w1 / q1, 1.0, rate);
    sections_[1].coefficients = bilinear(w2 * w2, 0.0, 0.0, w2 * w2, w2 / q1, 1.0, rate);
    sections_[2].coefficients = bilinear(w3 * w3, w3, 0.0, w3 * w3, w3 / q4, 1.0, rate);
}

std::complex<double> HandArmFilter::response(double frequency) const {
    std::complex<double> product = 1.0;
    for (const Biquad& section : sections_) product *= section.coefficients.response(frequency, rate_);
    return product;
}

double weighted_acceleration(const Spectrum& density) {
    double sum = 0.0;
    const auto weight = [&](std::size_t k) { return std::norm(hand_arm_weighting(density.frequency(k))); };
    for (std::size_t k = 1; k < density.power.size(); ++k) {
        // A Hann window spreads power with a variance of a third of a bin squared; the curvature of the weighting turns
        // that into a bias, which is subtracted.
        const double bent = (8.0 * weight(k) - weight(k - 1) - weight(k + 1)) / 6.0;
        sum += density.power[k] * bent;
    }
    return std::sqrt(sum * density.df);
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

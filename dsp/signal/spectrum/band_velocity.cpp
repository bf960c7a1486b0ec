// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/band_velocity.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

namespace tactus::signal {

namespace {

constexpr double max_section = 4.0;  // s

}  // namespace

BandVelocity::BandVelocity(double low, double high, double rate, std::size_t frames)
    : low_(low),
      high_(high),
      rate_(rate),
      section_(std::bit_floor(std::min(static_cast<std::size_t>(max_section * rate), frames))) {}

void BandVelocity::push(std::span<const double> samples) {
    if (section_ < 8) return;
    waiting_.insert(waiting_.end(), samples.begin(), samples.end());
    const std::size_t step = section_ / 2;
    std::size_t first = 0;
    for (; first + section_ <= waiting_.size(); first += step) {
        const std::vector<std::complex<double>> x =
            spectrum_of(std::span(waiting_).subspan(first, section_), section_);
        const auto size = static_cast<double>(section_);
        double power = 0.0;
        for (std::size_t k = 1; k + 1 < x.size(); ++k) {
            // The Hann window and its derivative as sums of neighbouring bins.
            const std::complex<double> windowed = 0.5 * x[k] - 0.25 * (x[k - 1] + x[k + 1]);
            const std::complex<double> derivative = std::complex<double>(0.0, -0.5) * (x[k - 1] - x[k + 1]);
            const double energy = std::norm(windowed);
            if (energy == 0.0) continue;
            const double shift = -0.5 * std::imag(derivative * std::conj(windowed)) / energy;
            const double frequency = (static_cast<double>(k) + shift) * rate_ / size;
            if (frequency < low_ || frequency > high_) continue;
            const double omega = 2.0 * pi * frequency;
            power += energy / (omega * omega);
        }
        // One-sided; 3/8 is the mean square of the window.
        sum_ += 2.0 * power / (0.375 * size * size);
        ++sections_;
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(first));
}

double BandVelocity::rms() const {
    return std::sqrt(sum_ / static_cast<double>(std::max<std::size_t>(1, sections_)));
}

bool BandVelocity::is_resolved() const {
    return sections_ > 0 && 4.0 * rate_ <= low_ * static_cast<double>(section_);
}

}  // namespace tactus::signal

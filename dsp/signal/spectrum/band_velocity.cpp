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

constexpr double section_periods = 8.0;
constexpr std::size_t max_section = 1 << 20;  // samples
constexpr double limit_range = 5e-3;  // relative width that is added at the limits of the band
constexpr std::size_t overlapping = 4;  // sections over a sample
constexpr double sum_of_squares = 1.5;  // of four Hann windows a quarter apart

/// Σ |W|²/ω² over the bins, each at the centre of its energy: the frequency of bin k is that of its middle less
/// Im(D conj W)/|W|² with D the transform by the window's derivative over the angle 2π n/size.
template <class Windowed, class Derivative>
double velocity_energy(std::size_t bins, double df, double low, double high, const Windowed& windowed,
                       const Derivative& derivative) {
    double sum = 0.0;
    for (std::size_t k = 1; k + 1 < bins; ++k) {
        const std::complex<double> w = windowed(k);
        const double energy = std::norm(w);
        if (energy == 0.0) continue;
        const double shift = -std::imag(derivative(k) * std::conj(w)) / energy;
        const double frequency = (static_cast<double>(k) + shift) * df;
        if (frequency < low || frequency > high) continue;
        const double omega = 2.0 * pi * frequency;
        sum += energy / (omega * omega);
    }
    return sum;
}

}  // namespace

BandVelocity::BandVelocity(double low, double high, double rate)
    : low_(low),
      high_(high),
      rate_(rate),
      section_(std::min(max_section, std::bit_ceil(std::max<std::size_t>(
                                         16, static_cast<std::size_t>(section_periods / low * rate))))) {
    for (std::size_t n = 0; n < section_; ++n) {
        const double w = 0.5 - 0.5 * std::cos(2.0 * pi * static_cast<double>(n) / static_cast<double>(section_));
        squares_.push_back(w * w);
    }
}

/// A whole section by a Hann window: the window and its derivative are sums of neighbouring bins.
void BandVelocity::add_inner(std::span<const double> samples) {
    const std::vector<std::complex<double>> x = spectrum_of(samples, section_);
    const auto size = static_cast<double>(section_);
    sum_ += 2.0 / size *
            velocity_energy(
                x.size(), rate_ / size, (1.0 - limit_range) * low_, (1.0 + limit_range) * high_,
                [&](std::size_t k) { return 0.5 * x[k] - 0.25 * (x[k - 1] + x[k + 1]); },
                [&](std::size_t k) { return std::complex<double>(0.0, -0.25) * (x[k - 1] - x[k + 1]); });
    weight_ += 0.25 * sum_of_squares * size;
}

/// A section at an end of a piece, of at most a whole section's samples. Its window does not suppress a constant part,
/// which is therefore subtracted.
void BandVelocity::add_windowed(std::span<const double> samples, std::span<const double> window) {
    const std::size_t count = samples.size();
    double total = 0.0, mean = 0.0;
    for (std::size_t n = 0; n < count; ++n) total += window[n], mean += window[n] * samples[n];
    mean /= total;
    const double to_angle = static_cast<double>(section_) / (2.0 * pi);
    std::vector<double> windowed(count), derived(count);
    for (std::size_t n = 0; n < count; ++n) {
        const double before = n > 0 ? window[n - 1] : 0.0, after = n + 1 < count ? window[n + 1] : 0.0;
        windowed[n] = window[n] * (samples[n] - mean);
        derived[n] = to_angle * 0.5 * (after - before) * (samples[n] - mean);
        weight_ += window[n] * window[n];
    }
    const std::vector<std::complex<double>> w = spectrum_of(windowed, section_), d = spectrum_of(derived, section_);
    const auto size = static_cast<double>(section_);
    sum_ += 2.0 / size *
            velocity_energy(
                w.size(), rate_ / size, (1.0 - limit_range) * low_, (1.0 + limit_range) * high_,
                [&](std::size_t k) { return w[k]; }, [&](std::size_t k) { return d[k]; });
}

/// Lets a window rise at the start of a piece and fall at its end, as a Hann window of twice the length.
void BandVelocity::taper(std::span<double> window, bool at_start, bool at_end) const {
    const auto length = static_cast<std::size_t>(taper_periods / low_ * rate_);
    for (std::size_t n = 0; n < std::min(length, window.size()); ++n) {
        const double angle = 0.5 * pi * (static_cast<double>(n) + 0.5) / static_cast<double>(length);
        const double rise = std::sin(angle) * std::sin(angle);
        if (at_start) window[n] *= rise;
        if (at_end) window[window.size() - 1 - n] *= rise;
    }
}

/// Window that adds to the squares of those before what sections would add that begin at `first` and each quarter of a
/// section later.
std::vector<double> BandVelocity::rest_from(std::size_t first, std::size_t size) const {
    const std::size_t step = section_ / overlapping;
    std::vector<double> window(size, 0.0);
    for (std::size_t n = first; n < size; ++n) {
        for (std::size_t from = first; from <= n; from += step)
            if (n - from < section_) window[n] += squares_[n - from];
        window[n] = std::sqrt(window[n]);
    }
    return window;
}

void BandVelocity::push(std::span<const double> samples) {
    pending_ += static_cast<double>(samples.size());
    waiting_.insert(waiting_.end(), samples.begin(), samples.end());
    const std::size_t step = section_ / overlapping;
    std::size_t last = 0;  // start of the last section in `waiting_`
    if (!has_section_ && waiting_.size() >= section_) {
        // What later sections leave.
        std::vector<double> window = rest_from(step, section_);
        for (double& w : window) w = std::sqrt(std::max(0.0, sum_of_squares - w * w));
        taper(window, true, false);
        add_windowed(std::span(waiting_).first(section_), window);
        has_section_ = true;
    }
    if (!has_section_) return;
    for (; last + step + section_ <= waiting_.size(); last += step)
        add_inner(std::span(waiting_).subspan(last + step, section_));
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(last));
}

void BandVelocity::end_piece() {
    const std::span<const double> rest(waiting_);
    if (has_section_) {
        const std::size_t step = section_ / overlapping;
        std::vector<double> window = rest_from(0, rest.size() - step);
        taper(window, false, true);
        add_windowed(rest.subspan(step), window);
    } else if (static_cast<double>(rest.size()) >= min_piece() * rate_ && rest.size() >= 16) {
        std::vector<double> window(rest.size(), std::sqrt(sum_of_squares));
        taper(window, true, true);
        add_windowed(rest, window);
    }
    samples_ += pending_;
    pending_ = 0.0;
    waiting_.clear();
    has_section_ = false;
}

double BandVelocity::rms() const { return weight_ > 0.0 ? std::sqrt(sum_ / weight_) : 0.0; }

double BandVelocity::coverage() const { return samples_ > 0.0 ? weight_ / (sum_of_squares * samples_) : 0.0; }

}  // namespace tactus::signal

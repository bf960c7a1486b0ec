// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/order/rotation.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::signal {

namespace {

/// Power at a position between two bins of a zero-padded spectrum.
double between(std::span<const double> power, double bin) {
    const auto k = static_cast<std::size_t>(bin);
    if (k + 1 >= power.size()) return 0.0;
    const double share = bin - static_cast<double>(k);
    return (1.0 - share) * power[k] + share * power[k + 1];
}

/// Mean level of the orders above the frame's noise floor. Low orders have more weight, or half the rate would explain
/// the same lines equally well.
double salience(std::span<const double> power, double floor, double bins_per_hz, double frequency, int orders) {
    double sum = 0.0, weights = 0.0;
    for (int k = 1; k <= orders; ++k) {
        const double bin = k * frequency * bins_per_hz, weight = 1.0 / std::sqrt(k);
        weights += weight;
        if (bin + 1.0 < static_cast<double>(power.size()))
            sum += weight * std::log10(1.0 + between(power, bin) / floor);
    }
    return sum / weights;
}

}  // namespace

Rotation rotation_from_tacho(std::span<const double> tacho, double rate, double pulses) {
    if (tacho.empty()) throw Error("the tachometer channel is empty");
    const auto [low, high] = std::minmax_element(tacho.begin(), tacho.end());
    TachoStream stream(*low, *high, rate);
    stream.push(tacho);
    return stream.rotation(pulses);
}

void TachoStream::push(std::span<const double> tacho) {
    for (const double x : tacho) {
        const std::size_t i = count_++;
        const double before = before_;
        before_ = x;
        if (i == 0) continue;
        if (x < middle_ - hysteresis_) armed_ = true;
        if (!armed_ || x < middle_ || before >= middle_) continue;
        armed_ = false;
        times_.push_back((static_cast<double>(i) - (x - middle_) / (x - before)) / rate_);
    }
}

Rotation TachoStream::rotation(double pulses) const {
    if (times_.size() < 4)
        throw Error(
            fmt::format("the tachometer channel has {} pulses; order analysis needs at least 4", times_.size()));
    std::vector<double> turns(times_.size());
    for (std::size_t i = 0; i < turns.size(); ++i) turns[i] = static_cast<double>(i) / pulses;
    return {std::move(turns), times_};
}

Rotation rotation_at(double frequency, double seconds) { return {{0.0, seconds * frequency}, {0.0, seconds}}; }

Rotation Ridge::rotation(double seconds) const {
    // Revolutions: trapezoidal integral of the rate, from the first sample to the last.
    std::vector<double> turns{0.0}, times{0.0};
    for (std::size_t i = 0; i <= time.size(); ++i) {
        const double t = i < time.size() ? time[i] : seconds;
        const double before = frequency[i == 0 ? 0 : i - 1], now = frequency[std::min(i, time.size() - 1)];
        if (t <= times.back()) continue;
        turns.push_back(turns.back() + 0.5 * (before + now) * (t - times.back()));
        times.push_back(t);
    }
    return {std::move(turns), std::move(times)};
}

RidgeStream::RidgeStream(double rate, const RidgeSettings& settings)
    : rate_(rate),
      settings_(settings),
      frame_(static_cast<std::size_t>(settings.frame * rate)),
      hop_(std::max<std::size_t>(1, frame_ / 4)),
      max_frames_(960),
      bins_per_hz_(static_cast<double>(std::bit_ceil(4 * std::max<std::size_t>(frame_, 16))) / rate),
      grid_(std::max(0.002, 0.25 / (settings.frame * settings.highest))),
      window_(make_window(WindowKind::hann, std::max<std::size_t>(frame_, 16))),
      x_(std::bit_ceil(4 * std::max<std::size_t>(frame_, 16))),
      fft_(x_.size()) {
    if (!(settings.lowest > 0.0) || !(settings.highest > settings.lowest))
        throw Error("the range of the rate must begin above 0 Hz and end above its beginning");
    for (double f = settings.lowest; f <= settings.highest; f *= 1.0 + grid_) candidates_.push_back(f);
    score_.resize(candidates_.size());
    next_.resize(candidates_.size());
    power_.resize(fft_.bins());
    spectrum_.resize(fft_.bins());
    top_ = static_cast<std::size_t>(
        std::min(static_cast<double>(fft_.bins()), 1.2 * settings.orders * settings.highest * bins_per_hz_));
}

void RidgeStream::push(std::span<const double> samples) {
    held_.insert(held_.end(), samples.begin(), samples.end());
    while (frame_ >= 16 && held_.size() >= (max_frames_ - 1) * hop_ + frame_) track(max_frames_);
}

Ridge RidgeStream::finish() {
    if (frame_ < 16 || held_.size() + done_ * hop_ < 2 * frame_)
        throw Error(fmt::format("tracking a rate needs at least {:.3g} s; state it with --rate instead",
                                std::max(2.0 * settings_.frame, 32.0 / rate_)));
    if (held_.size() >= frame_) track((held_.size() - frame_) / hop_ + 1);
    ridge_.prominence_db /= static_cast<double>(done_);
    return std::move(ridge_);
}

/// Sets the power of a frame; returns its noise floor.
double RidgeStream::power_of(std::span<const double> samples) {
    std::fill(x_.begin(), x_.end(), 0.0);
    for (std::size_t j = 0; j < frame_; ++j) x_[j] = samples[j] * window_[j];
    fft_.forward(x_, spectrum_);
    for (std::size_t k = 0; k < power_.size(); ++k) power_[k] = std::norm(spectrum_[k]);
    sorted_.assign(power_.begin() + 1, power_.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(top_, 3)));
    const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
    std::nth_element(sorted_.begin(), middle, sorted_.end());
    // Without noise, the window's side lobes must not count as orders.
    const double strongest = *std::max_element(sorted_.begin(), sorted_.end());
    return std::max({*middle, 1e-4 * strongest, 1e-300});
}

/// The best path through so many frames from the first held sample on.
void RidgeStream::track(std::size_t frames) {
    const std::size_t count = candidates_.size();
    const auto reach = std::max<std::ptrdiff_t>(1, std::lround(settings_.max_change / grid_));
    std::vector<std::uint16_t> from(frames * count);
    const auto frame_at = [&](std::size_t i) { return std::span<const double>(held_).subspan(i * hop_, frame_); };
    for (std::size_t i = 0; i < frames; ++i) {
        const double floor = power_of(frame_at(i));
        for (std::size_t c = 0; c < count; ++c) {
            double best = -1.0;
            std::size_t origin = c;
            if (i + done_ > 0)
                for (std::ptrdiff_t step = -reach; step <= reach; ++step) {
                    const auto b = static_cast<std::ptrdiff_t>(c) + step;
                    if (b < 0 || b >= static_cast<std::ptrdiff_t>(count)) continue;
                    // A small cost of changes keeps the path straight through noise.
                    const double value = score_[static_cast<std::size_t>(b)] -
                                         0.3 * std::abs(static_cast<double>(step)) / static_cast<double>(reach);
                    if (value > best) best = value, origin = static_cast<std::size_t>(b);
                }
            next_[c] = std::max(best, 0.0) + salience(power_, floor, bins_per_hz_, candidates_[c], settings_.orders);
            from[i * count + c] = static_cast<std::uint16_t>(origin);
        }
        std::swap(score_, next_);
    }
    std::vector<std::size_t> path(frames);
    path[frames - 1] = static_cast<std::size_t>(std::max_element(score_.begin(), score_.end()) - score_.begin());
    for (std::size_t i = frames - 1; i-- > 0;) path[i] = from[(i + 1) * count + path[i + 1]];
    for (std::size_t i = 0; i < frames; ++i) {
        const double floor = power_of(frame_at(i));
        const auto value = [&](double f) { return salience(power_, floor, bins_per_hz_, f, settings_.orders); };
        double a = candidates_[path[i]] * (1.0 - 1.5 * grid_), b = candidates_[path[i]] * (1.0 + 1.5 * grid_);
        for (int round = 0; round < 30; ++round) {
            const double left = a + (b - a) / 3.0, right = b - (b - a) / 3.0;
            if (value(left) < value(right)) a = left;
            else b = right;
        }
        ridge_.time.push_back((static_cast<double>((done_ + i) * hop_) + 0.5 * static_cast<double>(frame_)) / rate_);
        ridge_.frequency.push_back(0.5 * (a + b));
        // Counts only orders below half the sample rate.
        const double held = static_cast<double>(power_.size()) / (0.5 * (a + b) * bins_per_hz_);
        const int there = std::clamp(static_cast<int>(held), 1, settings_.orders);
        ridge_.prominence_db += 10.0 * salience(power_, floor, bins_per_hz_, 0.5 * (a + b), there);
    }
    // What the next frames may go on from, without the sum growing for hours.
    const double most = *std::max_element(score_.begin(), score_.end());
    for (double& score : score_) score = std::max(0.0, score - most + 100.0);
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(frames * hop_));
    done_ += frames;
}

Ridge track_ridge(std::span<const double> record, double rate, const RidgeSettings& settings) {
    RidgeStream stream(rate, settings);
    stream.push(record);
    return stream.finish();
}

}  // namespace tactus::signal

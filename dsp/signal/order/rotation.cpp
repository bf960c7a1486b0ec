// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/order/rotation.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace tactus::signal {

namespace {

constexpr double max_smoothing = 1e6;  // smooths over about ten pulses
constexpr std::size_t end_frames = 5;  // of a ridge, from which its ends are extrapolated

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

/// Minimum of Σ (z − x)² + λ Σ w (Δ³z)² (Whittaker 1923; Eilers 2003), by the Cholesky factors of a matrix of three
/// diagonals beside the main one. A parabola stays as it is, at its ends too. `weights`: w, one per third difference.
std::vector<double> whittaker(std::span<const double> x, std::span<const double> weights, double lambda) {
    constexpr double third[] = {-1.0, 3.0, -3.0, 1.0};
    const std::size_t n = x.size();
    // Row i: elements i − 3 … i of I + λDᵀD = LLᵀ.
    std::vector<std::array<double, 4>> l(n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t back = 0; back <= std::min<std::size_t>(3, i); ++back) {
            double sum = back == 0 ? 1.0 : 0.0;
            for (std::size_t row = i > 3 ? i - 3 : 0; row + 3 < n && row + back <= i; ++row)
                sum += lambda * weights[row] * third[i - row] * third[i - back - row];
            l[i][3 - back] = sum;
        }
        for (std::size_t j = i > 3 ? i - 3 : 0; j <= i; ++j) {
            double& element = l[i][3 - (i - j)];
            for (std::size_t k = i > 3 ? i - 3 : 0; k < j; ++k) element -= l[i][3 - (i - k)] * l[j][3 - (j - k)];
            element = j < i ? element / l[j][3] : std::sqrt(element);
        }
    }
    std::vector<double> z(x.begin(), x.end());
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t back = 1; back <= std::min<std::size_t>(3, i); ++back) z[i] -= l[i][3 - back] * z[i - back];
        z[i] /= l[i][3];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t on = 1; on <= std::min<std::size_t>(3, n - 1 - i); ++on) z[i] -= l[i + on][3 - on] * z[i + on];
        z[i] /= l[i][3];
    }
    return z;
}

/// The smoothest times whose distance from the given ones is at most `distance` (root of the sum of squares) and
/// `farthest` for each (discrepancy principle, Morozov 1966).
std::vector<double> smoothed(std::span<const double> times, double distance, double farthest) {
    if (!(distance > 0.0)) return {times.begin(), times.end()};
    // Less the line through both ends: a rate that hardly varies leaves little to round.
    const double step = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    std::vector<double> rest(times.size()), best;
    for (std::size_t i = 0; i < times.size(); ++i) rest[i] = times[i] - times[0] - step * static_cast<double>(i);
    // At a low rate a sample is a small part of the period, and the rate may change much from one pulse to the next: third
    // differences of a steady acceleration are as the fifth power of the period. The fourth smooths them too.
    std::vector<double> weights;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 3 < times.size(); ++i) {
        weights.push_back(times[i + 3] - times[i]);
        shortest = std::min(shortest, weights.back());
    }
    for (double& weight : weights) weight = std::pow(shortest / weight, 8.0);
    const auto is_near = [&](const std::vector<double>& z) {
        double squares = 0.0, most = 0.0;
        for (std::size_t i = 0; i < z.size(); ++i) {
            squares += (z[i] - rest[i]) * (z[i] - rest[i]);
            most = std::max(most, std::abs(z[i] - rest[i]));
        }
        return squares <= distance * distance && most <= farthest;
    };
    best = whittaker(rest, weights, max_smoothing);
    if (!is_near(best)) {
        double low = -3.0, high = std::log10(max_smoothing);  // log10 λ
        best = rest;
        for (int round = 0; round < 10; ++round) {
            const double middle = 0.5 * (low + high);
            std::vector<double> z = whittaker(rest, weights, std::pow(10.0, middle));
            const bool near = is_near(z);
            (near ? low : high) = middle;
            if (near) best = std::move(z);
        }
    }
    for (std::size_t i = 0; i < times.size(); ++i) best[i] += times[0] + step * static_cast<double>(i);
    // Times of pulses increase.
    return std::ranges::adjacent_find(best, std::greater_equal<>()) == best.end()
               ? best
               : std::vector<double>(times.begin(), times.end());
}

/// Frequency at `t` on the line of least squares through so many points of a ridge from `first` on.
double on_line(const Ridge& ridge, std::size_t first, std::size_t count, double t) {
    double time = 0.0, frequency = 0.0, squares = 0.0, products = 0.0;
    for (std::size_t i = first; i < first + count; ++i) time += ridge.time[i], frequency += ridge.frequency[i];
    time /= static_cast<double>(count), frequency /= static_cast<double>(count);
    for (std::size_t i = first; i < first + count; ++i) {
        squares += (ridge.time[i] - time) * (ridge.time[i] - time);
        products += (ridge.time[i] - time) * ridge.frequency[i];
    }
    const double there = squares > 0.0 ? frequency + products / squares * (t - time) : frequency;
    return std::clamp(there, 0.8 * frequency, 1.25 * frequency);
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
        steep_ += x - before >= steep_edge_;
        times_.push_back((static_cast<double>(i) - (x - middle_) / (x - before)) / rate_);
    }
}

Rotation TachoStream::rotation(double pulses) const {
    if (times_.size() < 4)
        throw Error(
            fmt::format("the tachometer channel has {} pulses; order analysis needs at least 4", times_.size()));
    std::vector<double> turns(times_.size());
    for (std::size_t i = 0; i < turns.size(); ++i) turns[i] = static_cast<double>(i) / pulses;
    return {std::move(turns), smoothed(times_, std::sqrt(static_cast<double>(steep_) / 12.0) / rate_, 1.0 / rate_)};
}

Rotation rotation_at(double frequency, double seconds) { return {{0.0, seconds * frequency}, {0.0, seconds}}; }

Rotation Ridge::rotation(double seconds) const {
    // Revolutions: trapezoidal integral of the rate, from the first sample to the last. Half a frame at each end has no
    // frame of its own.
    const std::size_t count = std::min(end_frames, time.size());
    std::vector<double> turns{0.0}, times{0.0};
    double before = on_line(*this, 0, count, 0.0);
    for (std::size_t i = 0; i <= time.size(); ++i) {
        const double t = i < time.size() ? time[i] : seconds;
        const double now = i < time.size() ? frequency[i] : on_line(*this, time.size() - count, count, seconds);
        if (t <= times.back()) continue;
        turns.push_back(turns.back() + 0.5 * (before + now) * (t - times.back()));
        times.push_back(t);
        before = now;
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

// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/level.hpp"

#include <cstring>

namespace tactus::signal {

namespace {

/// A register of every x86-64 and AArch64.
using Two = double __attribute__((vector_size(16)));
constexpr std::size_t lanes = 2;

}  // namespace

/// Blocks are merged as by Chan, Golub and LeVeque (1979): as accurate as Welford's recurrence for a small vibration on a
/// large offset, without its division per sample.
Level::Spread Level::merged() const noexcept {
    const std::size_t rest = (count_ + block - 1) % block + 1;
    if (count_ == 0) return {};
    const auto all = static_cast<double>(count_), n = static_cast<double>(rest);
    const double away = first_ + sum_ / n - whole_.mean;
    return {whole_.mean + away * (n / all),
            whole_.squares + std::fmax(0.0, sum_of_squares_ - sum_ * sum_ / n) + away * away * (n * (all - n) / all)};
}

void Level::push(std::span<const double> samples) noexcept {
    while (!samples.empty()) {
        if (count_ % block == 0) {
            whole_ = merged();
            first_ = samples.front();
            sum_ = sum_of_squares_ = 0.0;
        }
        const std::span<const double> part = samples.first(std::min(samples.size(), block - count_ % block));
        samples = samples.subspan(part.size());
        if (!stays_inside(part)) follow_limits(part);
        count_ += part.size();
        last_ = part.back();
        for (const double x : part) {
            const double difference = x - first_;
            sum_ += difference;
            sum_of_squares_ += difference * difference;
        }
    }
}

/// Most samples lie between the limits so far: returns false, and changes nothing, if one does not.
bool Level::stays_inside(std::span<const double> samples) noexcept {
    const std::size_t n = samples.size();
    if (count_ == 0 || n < lanes + 1) return false;
    const double infinite = std::numeric_limits<double>::infinity();
    const Two zero{};
    Two low = zero + infinite, high = zero - infinite, least = low;
    const auto add = [&](std::size_t at) {
        Two x, before;
        std::memcpy(&x, samples.data() + at, sizeof(x));
        std::memcpy(&before, samples.data() + at - 1, sizeof(before));
        low = x < low ? x : low;
        high = x > high ? x : high;
        const Two change = x - before, step = change < zero ? -change : change;
        least = (step > zero) & (step < least) ? step : least;
    };
    for (std::size_t i = 1; i + lanes <= n; i += lanes) add(i);
    add(n - lanes);  // the last ones, some of them twice
    double lowest = samples.front(), highest = samples.front(), quantum = quantum_;
    if (const double step = std::fabs(samples.front() - last_); step > 0.0) quantum = std::fmin(quantum, step);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        lowest = std::fmin(lowest, low[lane]);
        highest = std::fmax(highest, high[lane]);
        quantum = std::fmin(quantum, least[lane]);
    }
    if (!(lowest > low_ && highest < high_)) return false;
    quantum_ = quantum;
    at_low_.run = at_high_.run = 0;
    std::size_t same = 1;
    while (same < n && samples[n - same - 1] == samples[n - 1]) ++same;
    dwell_ = same == n && samples.front() == last_ ? dwell_ + n : same;
    return true;
}

void Level::follow_limits(std::span<const double> samples) noexcept {
    std::size_t before = count_;
    double last = last_;
    for (const double x : samples) {
        const bool is_first = before++ == 0;
        if (const double step = std::fabs(x - last); !is_first && step > 0.0) quantum_ = std::fmin(quantum_, step);
        if (is_first || x < low_) low_ = x, at_low_ = {};
        if (is_first || x > high_) high_ = x, at_high_ = {};
        // Coarse quantisation makes short runs at a wave's top, not much longer than on the step before.
        const std::size_t needed = quantum_ > 1e-3 * (high_ - low_) ? 6 * dwell_ + 1 : 3;
        at_low_.take(x == low_, needed);
        at_high_.take(x == high_, needed);
        dwell_ = !is_first && x == last ? dwell_ + 1 : 1;
        last = x;
    }
}

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/order/rotation.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/fft.hpp"
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
    const double middle = 0.5 * (*low + *high), hysteresis = 0.1 * (*high - *low);
    std::vector<double> turns, times;
    bool armed = false;
    for (std::size_t i = 1; i < tacho.size(); ++i) {
        if (tacho[i] < middle - hysteresis) armed = true;
        if (!armed || tacho[i] < middle || tacho[i - 1] >= middle) continue;
        armed = false;
        turns.push_back(static_cast<double>(turns.size()) / pulses);
        times.push_back((static_cast<double>(i) - (tacho[i] - middle) / (tacho[i] - tacho[i - 1])) / rate);
    }
    if (turns.size() < 4)
        throw Error(fmt::format("the tachometer channel has {} pulses; order analysis needs at least 4", turns.size()));
    return {std::move(turns), std::move(times)};
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

Ridge track_ridge(std::span<const double> record, double rate, const RidgeSettings& settings) {
    const auto frame = static_cast<std::size_t>(settings.frame * rate);
    if (frame < 16 || record.size() < 2 * frame)
        throw Error(fmt::format("tracking a rate needs at least {:.3g} s; state it with --rate instead",
                                std::max(2.0 * settings.frame, 32.0 / rate)));
    if (!(settings.lowest > 0.0) || !(settings.highest > settings.lowest))
        throw Error("the range of the rate must begin above 0 Hz and end above its beginning");
    const std::size_t hop = std::max<std::size_t>(1, frame / 4), padded = std::bit_ceil(4 * frame);
    const double bins_per_hz = static_cast<double>(padded) / rate;
    const double grid = std::max(0.002, 0.25 / (settings.frame * settings.highest));
    std::vector<double> candidates;
    for (double f = settings.lowest; f <= settings.highest; f *= 1.0 + grid) candidates.push_back(f);
    const std::size_t count = candidates.size(), frames = (record.size() - frame) / hop + 1;
    const auto reach = std::max<std::ptrdiff_t>(1, std::lround(settings.most_change / grid));

    const std::vector<double> window = make_window(WindowKind::hann, frame);
    RealFft<double> fft(padded);
    std::vector<double> x(padded), power(fft.bins()), sorted, score(count), next(count);
    std::vector<std::complex<double>> spectrum(fft.bins());
    const auto top = static_cast<std::size_t>(
        std::min(static_cast<double>(fft.bins()), 1.2 * settings.orders * settings.highest * bins_per_hz));
    std::vector<std::uint16_t> from(frames * count);
    const auto power_of = [&](std::size_t i) {
        std::fill(x.begin(), x.end(), 0.0);
        for (std::size_t j = 0; j < frame; ++j) x[j] = record[i * hop + j] * window[j];
        fft.forward(x, spectrum);
        for (std::size_t k = 0; k < power.size(); ++k) power[k] = std::norm(spectrum[k]);
        sorted.assign(power.begin() + 1, power.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(top, 3)));
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        std::nth_element(sorted.begin(), middle, sorted.end());
        // Without noise, the window's side lobes must not count as orders.
        const double strongest = *std::max_element(sorted.begin(), sorted.end());
        return std::max({*middle, 1e-4 * strongest, 1e-300});
    };
    for (std::size_t i = 0; i < frames; ++i) {
        const double floor = power_of(i);
        for (std::size_t c = 0; c < count; ++c) {
            double best = -1.0;
            std::size_t origin = c;
            if (i > 0)
                for (std::ptrdiff_t step = -reach; step <= reach; ++step) {
                    const auto b = static_cast<std::ptrdiff_t>(c) + step;
                    if (b < 0 || b >= static_cast<std::ptrdiff_t>(count)) continue;
                    // A small cost of changes keeps the path straight through noise.
                    const double value = score[static_cast<std::size_t>(b)] -
                                         0.3 * std::abs(static_cast<double>(step)) / static_cast<double>(reach);
                    if (value > best) best = value, origin = static_cast<std::size_t>(b);
                }
            next[c] = std::max(best, 0.0) + salience(power, floor, bins_per_hz, candidates[c], settings.orders);
            from[i * count + c] = static_cast<std::uint16_t>(origin);
        }
        std::swap(score, next);
    }
    std::vector<std::size_t> path(frames);
    path[frames - 1] = static_cast<std::size_t>(std::max_element(score.begin(), score.end()) - score.begin());
    for (std::size_t i = frames - 1; i-- > 0;) path[i] = from[(i + 1) * count + path[i + 1]];

    Ridge ridge;
    for (std::size_t i = 0; i < frames; ++i) {
        const double floor = power_of(i);
        const auto value = [&](double f) { return salience(power, floor, bins_per_hz, f, settings.orders); };
        double a = candidates[path[i]] * (1.0 - 1.5 * grid), b = candidates[path[i]] * (1.0 + 1.5 * grid);
        for (int round = 0; round < 30; ++round) {
            const double left = a + (b - a) / 3.0, right = b - (b - a) / 3.0;
            if (value(left) < value(right)) a = left;
            else b = right;
        }
        ridge.time.push_back((static_cast<double>(i * hop) + 0.5 * static_cast<double>(frame)) / rate);
        ridge.frequency.push_back(0.5 * (a + b));
        // Counts only orders below half the sample rate.
        const double held = static_cast<double>(power.size()) / (0.5 * (a + b) * bins_per_hz);
        const int there = std::clamp(static_cast<int>(held), 1, settings.orders);
        ridge.prominence_db +=
            10.0 * salience(power, floor, bins_per_hz, 0.5 * (a + b), there) / static_cast<double>(frames);
    }
    return ridge;
}

}  // namespace tactus::signal

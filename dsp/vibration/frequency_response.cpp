// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/frequency_response.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::vibration {

std::vector<double> unwrapped_phase(std::span<const std::complex<double>> gain) {
    std::vector<double> phase(gain.size());
    for (std::size_t i = 0; i < gain.size(); ++i) {
        phase[i] = std::arg(gain[i]);
        if (i > 0) phase[i] = phase[i - 1] + std::remainder(phase[i] - phase[i - 1], 2.0 * pi);
    }
    return phase;
}

std::vector<std::complex<double>> interpolate(const FrequencyResponse& response, std::span<const double> hz) {
    const std::vector<double> phase = unwrapped_phase(response.gain);
    std::vector<double> level(response.gain.size());
    for (std::size_t i = 0; i < level.size(); ++i)
        level[i] = std::log(std::max(std::abs(response.gain[i]), std::numeric_limits<double>::min()));
    std::vector<std::complex<double>> out(hz.size());
    std::size_t right = 0;
    for (std::size_t i = 0; i < hz.size(); ++i) {
        while (right < response.hz.size() && response.hz[right] < hz[i]) ++right;
        const std::size_t b = std::min(right, response.hz.size() - 1), a = right == 0 ? 0 : std::min(right - 1, b);
        const double share = b > a && hz[i] < response.hz[b]
                                 ? std::log(hz[i] / response.hz[a]) / std::log(response.hz[b] / response.hz[a])
                                 : 1.0;
        out[i] = std::polar(std::exp(std::lerp(level[a], level[b], share)), std::lerp(phase[a], phase[b], share));
    }
    return out;
}

std::vector<double> minimum_phase(std::span<const double> hz, std::span<const double> magnitude) {
    const std::size_t count = hz.size();
    std::vector<double> u(count), slope(count - 1), phase(count);
    for (std::size_t i = 0; i < count; ++i) u[i] = std::log(hz[i]);
    for (std::size_t i = 0; i + 1 < count; ++i)
        slope[i] = std::log(magnitude[i + 1] / magnitude[i]) / (u[i + 1] - u[i]);
    // ∫ ln coth(|v|/2) dv from 0 to x: π²/4 − 2 Σ e^{−kx}/k² over odd k; the series converges slowly near 0, where the
    // integrand is ln(2/v) + v²/12 − 7v⁴/1440.
    const auto area = [](double x) {
        const double size = std::abs(x);
        double sum;
        if (size < 0.25) {
            sum = size * (1.0 + std::log(2.0 / std::max(size, 1e-300))) + size * size * size / 36.0 -
                  7.0 * std::pow(size, 5) / 7200.0;
        } else {
            const double q = std::exp(-size);
            double power = q, series = 0.0;
            for (int k = 1; k < 60; k += 2, power *= q * q) series += power / (k * k);
            sum = pi * pi / 4.0 - 2.0 * series;
        }
        return std::copysign(sum, x);
    };
    const double whole = pi * pi / 4.0;
    for (std::size_t i = 0; i < count; ++i) {
        // The slope is constant between two frequencies, so the integral over each interval is exact.
        double sum = slope.front() * (area(u.front() - u[i]) + whole) + slope.back() * (whole - area(u.back() - u[i]));
        for (std::size_t k = 0; k + 1 < count; ++k) sum += slope[k] * (area(u[k + 1] - u[i]) - area(u[k] - u[i]));
        phase[i] = sum / pi;
    }
    return phase;
}

Resonance fit_resonance(const FrequencyResponse& response, double lowest, double highest) {
    struct Point {
        double hz, db, weight;
    };
    std::vector<Point> points;
    for (std::size_t i = 0; i < response.hz.size(); ++i) {
        const double f = response.hz[i], size = std::abs(response.gain[i]);
        if (f < lowest || f > highest || !(size > 0.0)) continue;
        // Ignores frequencies dominated by noise; octaves have equal weight.
        const double width =
            std::log(response.hz[std::min(i + 1, response.hz.size() - 1)] / response.hz[i ? i - 1 : 0]);
        const double trust = response.coherence.empty() ? 1.0 : std::pow(response.coherence[i], 4);
        points.push_back({f, 20.0 * std::log10(size), width * trust});
    }
    if (points.size() < 8)
        throw Error(fmt::format("a resonance needs at least 8 frequencies between {:g} and {:g} Hz; there are {}",
                                lowest, highest, points.size()));
    std::vector<double> left(points.size());
    // Weighted mean of f(deviation from the model with its best constant gain).
    const auto residuals = [&](double f0, double damping, int order) {
        double sum = 0.0, weights = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double x = points[i].hz / f0;
            const double shape = 20.0 * order * std::log10(x) -
                                 10.0 * std::log10((1.0 - x * x) * (1.0 - x * x) + 4.0 * damping * damping * x * x);
            left[i] = points[i].db - shape;
            sum += points[i].weight * left[i];
            weights += points[i].weight;
        }
        double middle = sum / weights;
        // Robust constant gain: a weighted mean under the same robust loss, by iterative reweighting.
        for (int round = 0; round < 5; ++round) {
            sum = weights = 0.0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const double weight = points[i].weight / (1.0 + (left[i] - middle) * (left[i] - middle));
                sum += weight * left[i];
                weights += weight;
            }
            middle = sum / weights;
        }
        for (double& value : left) value -= middle;
    };
    const auto loss = [&](double f0, double damping, int order) {
        residuals(f0, damping, order);
        double sum = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) sum += points[i].weight * std::log1p(left[i] * left[i]);
        return sum;
    };
    // rms of the residual of a straight line over log frequency.
    const auto line_error = [&] {
        double w = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
        for (const Point& p : points) {
            const double u = std::log(p.hz);
            w += p.weight, x += p.weight * u, y += p.weight * p.db;
            xx += p.weight * u * u, xy += p.weight * u * p.db, yy += p.weight * p.db * p.db;
        }
        const double vx = xx / w - x / w * x / w, vy = yy / w - y / w * y / w, c = xy / w - x / w * y / w;
        return std::sqrt(std::max(0.0, vy - c * c / vx));
    };
    Resonance best;
    double least = std::numeric_limits<double>::infinity(), log_f = 0.0, log_z = 0.0;
    const auto look = [&](double u, double v, int order) {
        const double value = loss(std::exp(u), std::exp(v), order);
        if (value < least) least = value, log_f = u, log_z = v, best.order = order;
    };
    const double bottom = std::log(lowest), width = std::log(highest / lowest);
    const double damping_bottom = std::log(0.005), damping_width = std::log(2.0 / 0.005);
    constexpr int columns = 48, rows = 24;
    for (int order = 0; order <= 2; ++order)
        for (int i = 0; i <= columns; ++i)
            for (int j = 0; j <= rows; ++j)
                look(bottom + width * i / columns, damping_bottom + damping_width * j / rows, order);
    double du = width / columns, dv = damping_width / rows;
    for (int round = 0; round < 40; ++round, du *= 0.7, dv *= 0.7) {
        const double u = log_f, v = log_z;
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j)
                if (i || j) look(u + i * du, v + j * dv, best.order);
    }
    best.hz = std::exp(log_f);
    best.damping = std::exp(log_z);
    residuals(best.hz, best.damping, best.order);
    double square = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        square += points[i].weight * left[i] * left[i];
        weights += points[i].weight;
    }
    best.error_db = std::sqrt(square / weights);
    if (const double line = line_error(); line < 0.5 || best.error_db > 0.7 * line) best.hz = best.damping = 0.0;
    return best;
}

}  // namespace tactus::vibration

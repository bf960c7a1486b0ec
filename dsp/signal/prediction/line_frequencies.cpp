// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/prediction/line_frequencies.hpp"

#include "dsp/core/error.hpp"
#include "dsp/signal/prediction/burg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::signal {

namespace {

// P(z) = A(z) + z^-(p+1) A(1/z) and Q(z) = A(z) − z^-(p+1) A(1/z) have all their roots on the unit circle. P without
// its root at −1 and Q without its root at +1 are symmetric, so on the circle each is a real sum of cosines.
using Polynomial = std::vector<double>;

struct Halves {
    Polynomial sum, difference;  // degree p
};

Halves halves_of(std::span<const double> predictor) {
    const std::size_t p = predictor.size();
    Halves out{Polynomial(p + 1), Polynomial(p + 1)};
    const auto a = [&](std::size_t i) { return i == 0 ? 1.0 : i <= p ? predictor[i - 1] : 0.0; };
    double sum = 0.0, difference = 0.0;
    for (std::size_t i = 0; i <= p; ++i) {
        const double mirrored = a(p + 1 - i);
        sum = a(i) + mirrored - sum;
        difference = a(i) - mirrored + difference;
        out.sum[i] = sum;
        out.difference[i] = difference;
    }
    return out;
}

double on_circle(const Polynomial& symmetric, double angle) {
    const std::size_t half = (symmetric.size() - 1) / 2;
    double value = symmetric[half];
    for (std::size_t i = 0; i < half; ++i)
        value += 2.0 * symmetric[i] * std::cos(static_cast<double>(half - i) * angle);
    return value;
}

void add_roots(const Polynomial& symmetric, std::size_t steps, std::vector<double>& roots) {
    double low = 0.0, at_low = on_circle(symmetric, low);
    for (std::size_t i = 1; i <= steps; ++i) {
        double high = std::numbers::pi * static_cast<double>(i) / static_cast<double>(steps);
        const double next = high, at_next = on_circle(symmetric, next);
        if ((at_low < 0.0) != (at_next < 0.0)) {
            for (int round = 0; round < 60; ++round) {
                const double middle = 0.5 * (low + high);
                ((on_circle(symmetric, middle) < 0.0) == (at_low < 0.0) ? low : high) = middle;
            }
            roots.push_back(0.5 * (low + high));
        }
        low = next;
        at_low = at_next;
    }
}

}  // namespace

std::vector<double> line_frequencies(std::span<const double> predictor) {
    std::vector<double> stable(predictor.begin(), predictor.end());
    if (predictor.size() % 2 != 0 || predictor.size() > max_prediction_order || !reflection_of(stable))
        throw Error("only a stable predictor of even order has line spectral frequencies");
    const Halves halves = halves_of(predictor);
    std::vector<double> lines;
    // Narrow resonances bring two lines close together: then a finer search separates them.
    for (std::size_t steps = 1024; steps <= 65536; steps *= 4) {
        lines.clear();
        add_roots(halves.sum, steps, lines);
        add_roots(halves.difference, steps, lines);
        if (lines.size() == predictor.size()) break;
    }
    if (lines.size() != predictor.size())
        throw Error("a resonance of the predictor is too narrow for line frequencies");
    std::ranges::sort(lines);
    return lines;
}

void predictor_of_lines(std::span<const double> lines, std::span<double> predictor) noexcept {
    const std::size_t p = lines.size();
    // From the smallest line on, lines belong to the sum and the difference by turns.
    std::array<double, max_prediction_order + 2> halves[2] = {};
    for (std::size_t which = 0; which < 2; ++which) {
        auto& c = halves[which];
        c[0] = 1.0;
        std::size_t degree = 0;
        for (std::size_t i = which; i < p; i += 2) {
            const double b = -2.0 * std::cos(lines[i]);
            degree += 2;
            for (std::size_t k = degree; k >= 2; --k) c[k] += b * c[k - 1] + c[k - 2];
            c[1] += b * c[0];
        }
        // The root at −1 of the sum, at +1 of the difference.
        const double end = which == 0 ? 1.0 : -1.0;
        for (std::size_t k = p + 1; k >= 1; --k) c[k] += end * c[k - 1];
    }
    for (std::size_t i = 0; i < p; ++i) predictor[i] = 0.5 * (halves[0][i + 1] + halves[1][i + 1]);
}

}  // namespace tactus::signal

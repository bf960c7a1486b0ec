// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/prediction/burg.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::signal {

std::vector<double> burg(std::span<const double> record, std::size_t order) {
    if (record.size() <= 2 * order)
        throw Error(
            fmt::format("a record of {} samples is too short for a prediction of order {}", record.size(), order));
    std::vector<double> forward(record.begin(), record.end()), backward = forward;
    std::vector<double> reflection(order, 0.0);
    const std::size_t count = record.size();
    for (std::size_t m = 0; m < order; ++m) {
        double product = 0.0, power = 0.0;
        for (std::size_t i = m + 1; i < count; ++i) {
            product += forward[i] * backward[i - 1];
            power += forward[i] * forward[i] + backward[i - 1] * backward[i - 1];
        }
        if (!(power > 0.0)) break;
        const double k = -2.0 * product / power;
        reflection[m] = k;
        for (std::size_t i = count - 1; i > m; --i) {
            const double ahead = forward[i];
            forward[i] = ahead + k * backward[i - 1];
            backward[i] = backward[i - 1] + k * ahead;
        }
    }
    return reflection;
}

void predictor_of(std::span<const double> reflection, std::span<double> predictor) noexcept {
    for (std::size_t m = 0; m < reflection.size(); ++m) {
        const double k = reflection[m];
        for (std::size_t low = 0, high = m; low < high; ++low) {
            --high;
            const double a = predictor[low], b = predictor[high];
            predictor[low] = a + k * b;
            if (high != low) predictor[high] = b + k * a;
        }
        predictor[m] = k;
    }
}

bool reflection_of(std::span<double> predictor) noexcept {
    std::array<double, max_prediction_order> before{};
    for (std::size_t m = predictor.size(); m-- > 0;) {
        const double k = predictor[m], rest = 1.0 - k * k;
        if (!(rest > 0.0)) return false;
        std::copy_n(predictor.begin(), m, before.begin());
        for (std::size_t i = 0; i < m; ++i) predictor[i] = (before[i] - k * before[m - 1 - i]) / rest;
    }
    return true;
}

double prediction_gain(std::span<const double> reflection) noexcept {
    double gain = 1.0;
    for (const double k : reflection) gain /= 1.0 - k * k;
    return gain;
}

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/detection.hpp"

#include "dsp/core/error.hpp"
#include "dsp/statistics/distributions.hpp"

#include <cmath>
#include <numbers>

namespace tactus::psychophysics {

using statistics::normal_cdf;
using statistics::normal_density;
using statistics::normal_quantile;

Detection yes_no(double hits, double signals, double false_alarms, double noises) {
    if (!(signals > 0.0 && noises > 0.0 && hits >= 0.0 && hits <= signals && false_alarms >= 0.0 &&
          false_alarms <= noises))
        throw Error("d′ of a yes/no task needs trials with and without signal, and no more answers than trials");
    const double h = normal_quantile((hits + 0.5) / (signals + 1.0)),
                 f = normal_quantile((false_alarms + 0.5) / (noises + 1.0));
    return {h - f, -0.5 * (h + f)};
}

double correct_of_choice(double d_prime, int alternatives) {
    if (alternatives == 2) return normal_cdf(d_prime / std::numbers::sqrt2);
    constexpr int intervals = 4000;
    constexpr double reach = 10.0, step = 2.0 * reach / intervals;
    double sum = 0.0;
    for (int i = 0; i <= intervals; ++i) {
        const double x = -reach + step * i, weight = i == 0 || i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        sum += weight * normal_density(x) * std::pow(normal_cdf(x + d_prime), alternatives - 1);
    }
    return sum * step / 3.0;
}

double d_prime_of_choice(double correct, int alternatives) {
    if (!(correct > 0.0 && correct < 1.0)) throw Error("d′ needs a fraction of correct answers between 0 and 1");
    if (alternatives < 2) throw Error("a choice has at least two alternatives");
    if (alternatives == 2) return std::numbers::sqrt2 * normal_quantile(correct);
    if (correct <= 1.0 / alternatives) return 0.0;
    double low = 0.0, high = 10.0;
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (correct_of_choice(middle, alternatives) < correct ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double d_prime_of_same_different(double correct) {
    if (!(correct >= 0.0 && correct < 1.0)) throw Error("d′ needs a fraction of correct answers from 0 to below 1");
    if (correct <= 0.5) return 0.0;
    return 2.0 * normal_quantile(0.5 * (1.0 + std::sqrt(2.0 * correct - 1.0)));
}

}  // namespace tactus::psychophysics

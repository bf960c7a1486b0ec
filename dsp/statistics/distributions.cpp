// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::statistics {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// log of B(a, b).
double log_beta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

/// Continued fraction of the incomplete beta function; converges fast for x < (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
    constexpr double tiny = 1e-300;
    const auto away_from_zero = [](double v) { return std::abs(v) < tiny ? tiny : v; };
    double c = 1.0, d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)), value = d;
    for (int m = 1; m < 10'000; ++m) {
        const double k = m;
        const double even = k * (b - k) * x / ((a + 2.0 * k - 1.0) * (a + 2.0 * k));
        d = 1.0 / away_from_zero(1.0 + even * d);
        c = away_from_zero(1.0 + even / c);
        value *= d * c;
        const double odd = -(a + k) * (a + b + k) * x / ((a + 2.0 * k) * (a + 2.0 * k + 1.0));
        d = 1.0 / away_from_zero(1.0 + odd * d);
        c = away_from_zero(1.0 + odd / c);
        const double step = d * c;
        value *= step;
        if (std::abs(step - 1.0) < 1e-16) break;
    }
    return value;
}

}  // namespace

double normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi); }

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_quantile(double p) {
    if (!(p > 0.0)) return p == 0.0 ? -infinity : std::numeric_limits<double>::quiet_NaN();
    if (p >= 1.0) return p == 1.0 ? infinity : std::numeric_limits<double>::quiet_NaN();
    if (p > 0.5) return -normal_quantile(1.0 - p);
    const double t = std::sqrt(-2.0 * std::log(p));
    double x =
        -(t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))));
    for (int step = 0; step < 4; ++step) {
        const double error = (normal_cdf(x) - p) / normal_density(x);
        x -= error / (1.0 + 0.5 * x * error);
    }
    return x;
}

double incomplete_beta(double a, double b, double x) {
    if (!(x > 0.0)) return 0.0;
    if (x >= 1.0) return 1.0;
    const double front = std::exp(a * std::log(x) + b * std::log1p(-x) - log_beta(a, b));
    if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
    return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

double student_two_sided(double t, double freedom) {
    if (std::isinf(t)) return 0.0;
    return incomplete_beta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
}

double student_cdf(double t, double freedom) {
    const double tail = 0.5 * student_two_sided(t, freedom);
    return t < 0.0 ? tail : 1.0 - tail;
}

double student_quantile(double p, double freedom) {
    if (p > 0.5) return -student_quantile(1.0 - p, freedom);
    if (p == 0.5) return 0.0;
    if (!(p > 0.0)) return p == 0.0 ? -infinity : std::numeric_limits<double>::quiet_NaN();
    double low = -1.0, high = 0.0;
    while (student_cdf(low, freedom) > p) low *= 2.0;
    for (int step = 0; step < 200 && high - low > 1e-15 * std::abs(low); ++step) {
        const double middle = 0.5 * (low + high);
        (student_cdf(middle, freedom) > p ? high : low) = middle;
    }
    return 0.5 * (low + high);
}

double mean_over_deviation(double freedom, const std::function<double(double)>& f) {
    // Density of s: 2 (ν/2)^(ν/2) / Γ(ν/2) s^(ν−1) exp(−ν s²/2). It is negligible beyond 12 standard deviations 1/√(2ν).
    const double half = 0.5 * freedom, scale = std::numbers::ln2 + half * std::log(half) - std::lgamma(half);
    const double reach = 12.0 / std::sqrt(2.0 * freedom), low = std::max(0.0, 1.0 - reach), high = 1.0 + reach;
    constexpr int intervals = 600;
    const double step = (high - low) / intervals;
    double sum = 0.0;
    for (int i = 0; i <= intervals; ++i) {
        const double s = low + step * i;
        const double power = freedom == 1.0 ? 0.0 : (freedom - 1.0) * std::log(s);
        const double density = s > 0.0 || freedom == 1.0 ? std::exp(scale + power - half * s * s) : 0.0;
        const double weight = i == 0 || i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        if (density > 0.0) sum += weight * density * f(s);
    }
    return sum * step / 3.0;
}

double noncentral_student_cdf(double t, double freedom, double shift) {
    return mean_over_deviation(freedom, [&](double s) { return normal_cdf(t * s - shift); });
}

}  // namespace tactus::statistics

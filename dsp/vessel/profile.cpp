// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/profile.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace tactus::vessel {

namespace {

// exp(-x) I₀(x) for x >= 0: Abramowitz and Stegun, 9.8.1 and 9.8.2.
double scaled_bessel(double x) {
    if (x < 3.75) {
        const double t = x * x / (3.75 * 3.75);
        const double i0 =
            1.0 +
            t * (3.5156229 + t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
        return i0 * std::exp(-x);
    }
    const double t = 3.75 / x;
    return (0.39894228 +
            t * (0.01328592 +
                 t * (0.00225319 +
                      t * (-0.00157565 +
                           t * (0.00916281 +
                                t * (-0.02057706 + t * (0.02635537 + t * (-0.01647633 + t * 0.00392377)))))))) /
           std::sqrt(x);
}

double integrate(double distance, double radius) {  // in units of the blur
    constexpr int parts = 48;                       // Simpson
    const double low = std::max(0.0, distance - 6.0), high = std::min(radius, distance + 6.0);
    if (high <= low) return 0.0;
    const double step = (high - low) / parts;
    double sum = 0.0;
    for (int n = 0; n <= parts; ++n) {
        const double s = low + n * step;
        const double f = s * std::exp(-0.5 * (distance - s) * (distance - s)) * scaled_bessel(distance * s);
        sum += f * (n == 0 || n == parts ? 1.0 : n % 2 == 1 ? 4.0 : 2.0);
    }
    return sum * step / 3.0;
}

constexpr double radius_step = 0.1, max_radius = 12.0, offset_step = 0.1, max_offset = 5.0;
constexpr int radii = static_cast<int>(max_radius / radius_step) + 1;
constexpr int offsets = static_cast<int>(2.0 * max_offset / offset_step) + 1;

/// Over the radius and over distance minus radius, both in units of the blur.
struct Table {
    std::array<std::array<double, offsets>, radii> values{};

    Table() {
        for (int r = 1; r < radii; ++r)
            for (int o = 0; o < offsets; ++o) {
                const double radius = r * radius_step;
                values[static_cast<std::size_t>(r)][static_cast<std::size_t>(o)] =
                    integrate(std::max(0.0, radius + o * offset_step - max_offset), radius);
            }
    }

    double at(double distance, double radius) const {
        const double offset = distance - radius;
        if (radius >= max_radius)  // nearly a half plane; the second term is the curvature of its edge
            return 0.5 * std::erfc((offset + 0.5 / radius) / std::numbers::sqrt2);
        const double o = std::clamp((offset + max_offset) / offset_step, 0.0, offsets - 1.001);
        const double r = std::max(0.0, radius / radius_step);
        const std::size_t i = static_cast<std::size_t>(r), j = static_cast<std::size_t>(o);
        const double u = r - double(i), v = o - double(j);
        const auto& low = values[i];
        const auto& high = values[std::min<std::size_t>(i + 1, radii - 1)];
        return (1.0 - u) * (low[j] + v * (low[j + 1] - low[j])) + u * (high[j] + v * (high[j + 1] - high[j]));
    }
};

const Table& table_of_discs() {
    static const Table table;
    return table;
}

}  // namespace

double blurred_disc(double distance, double radius, double blur) {
    return table_of_discs().at(distance / blur, radius / blur);
}

ProfileValue blurred_profile(double squared_distance, double radius, double blur) {
    const Table& table = table_of_discs();
    const double d = std::sqrt(squared_distance) / blur, r = radius / blur;
    constexpr double h = 0.05;
    const double by_distance = (table.at(d + h, r) - table.at(std::max(0.0, d - h), r)) / (std::min(d, h) + h);
    // The radius changes with the distance kept.
    const double low = std::max(0.0, r - h);
    const double by_radius = (table.at(d, r + h) - table.at(d, low)) / (r + h - low);
    return {table.at(d, r), by_distance / (2.0 * std::max(d, 1e-3) * blur * blur), by_radius / blur};
}

}  // namespace tactus::vessel

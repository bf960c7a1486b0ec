// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/spline.hpp"

#include "dsp/core/error.hpp"

#include <algorithm>

namespace tactus::geometry {

Spline::Spline(std::vector<double> x, std::vector<double> y) : x_(std::move(x)), y_(std::move(y)), bend_(x_.size()) {
    const std::size_t n = x_.size();
    if (n < 2 || y_.size() != n) throw Error("a spline needs at least two points");
    for (std::size_t i = 1; i < n; ++i)
        if (!(x_[i] > x_[i - 1])) throw Error("the places of a spline's points must increase");
    if (n == 2) return;
    // Tridiagonal system for the second derivatives: forward elimination. Those of the ends equal their neighbours'.
    std::vector<double> upper(n);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double left = x_[i] - x_[i - 1], right = x_[i + 1] - x_[i];
        const double rest =
            2.0 * (left + right) - left * upper[i - 1] + (i == 1 ? left : 0.0) + (i + 2 == n ? right : 0.0);
        const double wanted = 6.0 * ((y_[i + 1] - y_[i]) / right - (y_[i] - y_[i - 1]) / left);
        upper[i] = right / rest;
        bend_[i] = (wanted - left * bend_[i - 1]) / rest;
    }
    for (std::size_t i = n - 2; i-- > 1;) bend_[i] -= upper[i] * bend_[i + 1];
    bend_[0] = bend_[1];
    bend_[n - 1] = bend_[n - 2];
}

Spline::Point Spline::operator()(double x) const noexcept {
    const auto after = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
    const auto i = static_cast<std::size_t>(after - x_.begin()) - 1;
    const double h = x_[i + 1] - x_[i], chord = (y_[i + 1] - y_[i]) / h;
    const double at = std::clamp(x, x_.front(), x_.back()) - x_[i], left = h - at;
    const double a = bend_[i], b = bend_[i + 1];
    const double slope = chord + (b * (3.0 * at * at - h * h) - a * (3.0 * left * left - h * h)) / (6.0 * h);
    const double value =
        y_[i] + chord * at + (b * at * (at * at - h * h) + a * left * (left * left - h * h)) / (6.0 * h);
    const double beyond = x - (x_[i] + at);
    return {value + slope * beyond, slope};
}

}  // namespace tactus::geometry

// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::window {

std::vector<double> linear_ticks(Range range, int most) {
    std::vector<double> ticks;
    if (!(range.span() > 0.0) || !std::isfinite(range.span()) || most < 1) return ticks;
    const double least = range.span() / most;
    const double decade = std::pow(10.0, std::floor(std::log10(least)));
    double step = 10.0 * decade;
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * decade >= least) {
            step = factor * decade;
            break;
        }
    const double first = std::ceil(range.low / step - 1e-9), last = std::floor(range.high / step + 1e-9);
    // Far from zero the steps may be smaller than the resolution of double.
    if (!(last - first <= 2.0 * most)) return ticks;
    for (double k = first; k <= last; ++k) ticks.push_back(k * step);
    if (static_cast<int>(ticks.size()) > most) ticks.resize(static_cast<std::size_t>(most));
    return ticks;
}

std::vector<double> decade_ticks(Range range, int most) {
    std::vector<double> all, decades;
    if (!(range.low > 0.0) || !(range.high > range.low) || !std::isfinite(range.high)) return all;
    for (int e = static_cast<int>(std::floor(std::log10(range.low))); std::pow(10.0, e) <= range.high; ++e)
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double tick = factor * std::pow(10.0, e);
            if (tick < range.low * (1.0 - 1e-9) || tick > range.high * (1.0 + 1e-9)) continue;
            all.push_back(tick);
            if (factor == 1.0) decades.push_back(tick);
        }
    return static_cast<int>(all.size()) <= most ? all : decades;
}

std::string tick_label(double value, double step) {
    if (std::abs(value) < 1e-9 * step) return "0";
    const double size = std::max(std::abs(value), step);
    if (size >= 1e5 || size < 1e-3) return fmt::format("{:.3g}", value);
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
    return fmt::format("{:.{}f}", value, digits);
}

Range fitted(Range shown, Range values) {
    if (!(values.high >= values.low) || !std::isfinite(values.span())) return shown;
    const double size = std::max(std::abs(values.low), std::abs(values.high));
    const double air = values.span() > 0.0 ? 0.08 * values.span() : size > 0.0 ? 0.1 * size : 1.0;
    const Range wanted{values.low - air, values.high + air};
    const bool holds = shown.span() > 0.0 && shown.low <= values.low && shown.high >= values.high;
    return holds && shown.span() < 2.0 * wanted.span() ? shown : wanted;
}

Envelope envelope_of(std::span<const double> times, std::span<const double> values, Range time, int columns,
                     double period) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const auto count = static_cast<std::size_t>(std::max(columns, 0));
    Envelope envelope{std::vector<double>(count, none), std::vector<double>(count, none),
                      std::vector<bool>(count, false)};
    if (!(time.span() > 0.0) || count == 0) return envelope;
    const auto first = static_cast<std::size_t>(std::ranges::lower_bound(times, time.low) - times.begin());
    bool is_broken = false;
    for (std::size_t at = first; at < times.size() && times[at] <= time.high; ++at) {
        is_broken |= at > first && period > 0.0 && times[at] - times[at - 1] > 1.5 * period;
        if (!std::isfinite(values[at])) {
            is_broken = true;
            continue;
        }
        const double where = (times[at] - time.low) / time.span() * columns;
        const std::size_t column = std::min(static_cast<std::size_t>(where), count - 1);
        double &low = envelope.low[column], &high = envelope.high[column];
        if (std::isnan(low)) envelope.begins[column] = is_broken;
        is_broken = false;
        if (!(values[at] >= low)) low = values[at];
        if (!(values[at] <= high)) high = values[at];
    }
    return envelope;
}

}  // namespace tactus::window

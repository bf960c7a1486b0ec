// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/mains.hpp"

#include <numeric>

namespace tactus::signal {

namespace {

struct MainsFit {
    MainsComb comb;
    int divisor = 0;
    double power = 0.0;
};

/// Grows a comb from its founding line: each line that fits reduces the uncertainty of the mains, which is that of
/// `mains_range` at first.
MainsFit grow_mains(std::span<const MainsLine> lines, int nominal, const MainsLine& founder, int founding_order) {
    MainsFit out;
    const double prior = mains_range * nominal / 3.0, first = founder.deviation / founding_order;
    double information = 1.0 / (prior * prior) + 1.0 / (first * first);
    double weighted = nominal / (prior * prior) + founder.frequency / founding_order / (first * first);
    out.comb = {nominal, weighted / information, 1.0 / std::sqrt(information), 0};
    for (const MainsLine& line : lines) {
        const int order = out.comb.order_of(line.frequency, line.deviation);
        if (order == 0) continue;
        out.divisor = std::gcd(out.divisor, order);
        out.power += line.power;
        ++out.comb.lines;
        if (&line == &founder) continue;
        const double more = order * order / (line.deviation * line.deviation);
        information += more;
        weighted += more * line.frequency / order;
        out.comb.frequency = weighted / information;
        out.comb.deviation = 1.0 / std::sqrt(information);
    }
    return out;
}

}  // namespace

int MainsComb::order_of(double hz, double line_deviation) const {
    const double order = std::round(hz / frequency);
    const double reach = 3.0 * std::hypot(line_deviation, order * deviation) + mains_drift * hz;
    return order >= 1.0 && order <= max_mains_order && std::abs(hz - order * frequency) <= reach
               ? static_cast<int>(order)
               : 0;
}

std::optional<MainsComb> fit_mains(std::span<const MainsLine> lines, int nominal) {
    MainsFit best;
    for (const MainsLine& founder : lines) {
        const int order = mains_order(founder.frequency, nominal, 3.0 * founder.deviation);
        if (order < 1 || order > max_founding_order) continue;
        const MainsFit fit = grow_mains(lines, nominal, founder, order);
        if (!is_hum_family(fit.divisor)) continue;
        if (fit.comb.lines > best.comb.lines || (fit.comb.lines == best.comb.lines && fit.power > best.power))
            best = fit;
    }
    return best.comb.lines > 0 ? std::optional(best.comb) : std::nullopt;
}

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/gripper/rig_findings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::analysis {

namespace {

/// Rate above which `fast` has a smaller error than `slow`, also at the next rate.
std::optional<double> crossing(const std::vector<double>& rates, const std::vector<double>& slow,
                               const std::vector<double>& fast) {
    double before = 0.0;
    for (std::size_t n = 0; n < rates.size(); ++n) {
        const double lead = std::log(slow[n] / fast[n]);  // above 0: the fast motor is better
        if (!std::isfinite(lead)) continue;
        if (lead > 0.0 && (n + 1 == rates.size() || slow[n + 1] > fast[n + 1])) {
            if (n == 0 || !(before < 0.0)) return rates[n];
            return rates[n - 1] * std::pow(rates[n] / rates[n - 1], before / (before - lead));
        }
        before = lead;
    }
    return std::nullopt;
}

std::vector<std::pair<double, double>> band_of(const RigErrors& errors) {
    std::vector<std::pair<double, double>> band(errors.front().size(), {1e9, 0.0});
    for (const auto& corner : errors)
        for (std::size_t n = 0; n < corner.size(); ++n)
            if (std::isfinite(corner[n]))
                band[n] = {std::min(band[n].first, corner[n]), std::max(band[n].second, corner[n])};
    return band;
}

}  // namespace

RigCrossover find_crossover(const std::vector<double>& rates, double stiffness, double amplitude, const RigErrors& slow,
                            const RigErrors& fast) {
    RigCrossover c{stiffness, amplitude, {}, {}, 0, 0, rates, band_of(slow), band_of(fast)};
    for (const auto& a : slow)
        for (const auto& b : fast) {
            ++c.of;
            const std::optional<double> rate = crossing(rates, a, b);
            if (!rate) continue;
            ++c.crossed;
            c.low = std::min(c.low.value_or(*rate), *rate);
            c.high = std::max(c.high.value_or(*rate), *rate);
        }
    return c;
}

RigFinding count_cases(std::string claim, const RigErrors& better, const RigErrors& worse) {
    RigFinding finding{std::move(claim), 0, 0};
    for (const auto& a : better)
        for (const auto& b : worse) {
            ++finding.of;
            finding.holds += a.front() < b.front();
        }
    return finding;
}

}  // namespace tactus::analysis

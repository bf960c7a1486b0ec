// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/posterior.hpp"

#include "dsp/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tactus::psychophysics {

PosteriorSettings threshold_prior(Form form, double guess, double lapse, std::span<const double> slopes, double low,
                                  double high) {
    constexpr int count = 8;
    constexpr double beyond = 4.0;
    if (slopes.empty()) throw Error("a threshold needs at least one slope");
    PosteriorSettings settings{form, guess, lapse, {}, low - 0.5 * (high - low), high + 0.5 * (high - low)};
    const double ratio = beyond * slopes.back() / slopes.front();
    for (int i = 0; i < count; ++i)
        settings.slopes.push_back(slopes.front() * std::pow(ratio, static_cast<double>(i) / (count - 1)));
    return settings;
}

PosteriorLevel posterior_level(std::span<const LevelCount> counts, const PosteriorSettings& settings, double p,
                               double confidence) {
    constexpr std::size_t cells = 600;
    if (counts.empty()) throw Error("a threshold needs answers");
    if (settings.slopes.empty()) throw Error("a threshold needs at least one slope");
    if (!(settings.low < settings.high)) throw Error("the range of a threshold must be ascending");
    const double width = (settings.high - settings.low) / cells;
    std::vector<std::vector<double>> likelihoods;
    double greatest = -std::numeric_limits<double>::infinity();
    for (const double slope : settings.slopes) {
        Psychometric function{settings.form, 0.0, slope, settings.guess, settings.lapse};
        const double above = function.level_of(p);
        if (!std::isfinite(above)) throw Error("no level has the probability of the threshold");
        std::vector<double>& own = likelihoods.emplace_back();
        for (std::size_t cell = 0; cell < cells; ++cell) {
            function.threshold = settings.low + (static_cast<double>(cell) + 0.5) * width - above;
            own.push_back(log_likelihood(counts, function));
            greatest = std::max(greatest, own.back());
        }
    }
    std::vector<double> mass(cells, 0.0);
    for (const std::vector<double>& own : likelihoods)
        for (std::size_t cell = 0; cell < cells; ++cell) mass[cell] += std::exp(own[cell] - greatest);
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
    const auto quantile = [&](double fraction) {
        double left = fraction * total;
        std::size_t cell = 0;
        while (cell + 1 < cells && left > mass[cell]) left -= mass[cell++];
        return settings.low + (static_cast<double>(cell) + left / mass[cell]) * width;
    };
    const double tail = 0.5 - 0.5 * confidence;
    return {quantile(0.5), {quantile(tail), quantile(1.0 - tail)}};
}

}  // namespace tactus::psychophysics

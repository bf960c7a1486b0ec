// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/fit.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace tactus::psychophysics {

namespace {

constexpr std::size_t max_free = 3;
using Place = std::array<double, max_free>;

/// Free parameters on a scale without borders: threshold, log slope, and a lapse that a sine keeps within its range.
class Objective {
public:
    Objective(std::span<const LevelCount> counts, const FitSettings& settings) : counts_(counts), settings_(settings) {
        free_slope_ = !settings.slope;
        free_lapse_ = !settings.lapse && settings.max_lapse > 0.0;
    }
    std::size_t size() const { return 1 + (free_slope_ ? 1 : 0) + (free_lapse_ ? 1 : 0); }
    bool has_slope() const { return free_slope_; }
    bool has_lapse() const { return free_lapse_; }
    Psychometric function(const Place& x) const {
        Psychometric f{settings_.form, x[0], settings_.slope.value_or(1.0), settings_.guess,
                       settings_.lapse.value_or(0.0)};
        std::size_t next = 1;
        if (free_slope_)
            f.slope = std::exp(std::clamp(x[next++], std::log(settings_.min_slope), std::log(settings_.max_slope)));
        if (free_lapse_) {
            const double s = std::sin(x[next]);
            f.lapse = settings_.max_lapse * s * s;
        }
        return f;
    }
    double operator()(const Place& x) const { return -log_likelihood(counts_, function(x)); }

private:
    std::span<const LevelCount> counts_;
    const FitSettings& settings_;
    bool free_slope_ = true, free_lapse_ = true;
};

struct Vertex {
    Place x{};
    double value = 0.0;
};

Vertex nelder_mead(const Objective& f, const Place& start, const Place& reach) {
    const std::size_t n = f.size();
    std::array<Vertex, max_free + 1> simplex;
    simplex[0] = {start, f(start)};
    for (std::size_t i = 0; i < n; ++i) {
        Place x = start;
        x[i] += reach[i];
        simplex[i + 1] = {x, f(x)};
    }
    const auto by_value = [](const Vertex& a, const Vertex& b) { return a.value < b.value; };
    const auto all = std::span(simplex.data(), n + 1);
    for (int step = 0; step < 600; ++step) {
        std::ranges::sort(all, by_value);
        double width = 0.0;
        for (std::size_t i = 0; i < n; ++i) width = std::max(width, std::abs(all[n].x[i] - all[0].x[i]) / reach[i]);
        if (all[n].value - all[0].value < 1e-12 && width < 1e-6) break;
        Place middle{};
        for (std::size_t v = 0; v < n; ++v)
            for (std::size_t i = 0; i < n; ++i) middle[i] += all[v].x[i] / static_cast<double>(n);
        const auto along = [&](double factor) {
            Vertex vertex;
            for (std::size_t i = 0; i < n; ++i) vertex.x[i] = middle[i] + factor * (all[n].x[i] - middle[i]);
            vertex.value = f(vertex.x);
            return vertex;
        };
        const Vertex reflected = along(-1.0);
        if (reflected.value < all[0].value) {
            const Vertex expanded = along(-2.0);
            all[n] = expanded.value < reflected.value ? expanded : reflected;
        } else if (reflected.value < all[n - 1].value) {
            all[n] = reflected;
        } else {
            const Vertex contracted = along(reflected.value < all[n].value ? -0.5 : 0.5);
            if (contracted.value < std::min(reflected.value, all[n].value)) {
                all[n] = contracted;
            } else {
                for (std::size_t v = 1; v <= n; ++v) {
                    for (std::size_t i = 0; i < n; ++i) all[v].x[i] = 0.5 * (all[v].x[i] + all[0].x[i]);
                    all[v].value = f(all[v].x);
                }
            }
        }
    }
    return *std::ranges::min_element(all, by_value);
}

double saturated_likelihood(std::span<const LevelCount> counts) {
    double sum = 0.0;
    for (const LevelCount& count : counts) {
        const double wrong = count.trials - count.correct;
        if (count.correct > 0.0) sum += count.correct * std::log(count.correct / count.trials);
        if (wrong > 0.0) sum += wrong * std::log(wrong / count.trials);
    }
    return sum;
}

double percentile_of(const std::vector<double>& sorted, double fraction) {
    const double at = fraction * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// Slope at which F rises from 25 % to 75 % within `width`.
double slope_of_width(Form form, double width) {
    const Psychometric unit{form, 0.0, 1.0, 0.0, 0.0};
    return (unit.level_of(0.75) - unit.level_of(0.25)) / width;
}

}  // namespace

std::vector<LevelCount> count_levels(std::span<const double> levels, const std::vector<bool>& correct) {
    std::map<double, LevelCount> counts;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        LevelCount& count = counts[levels[i]];
        count.level = levels[i];
        count.trials += 1.0;
        count.correct += correct[i] ? 1.0 : 0.0;
    }
    std::vector<LevelCount> list;
    for (const auto& [level, count] : counts) list.push_back(count);
    return list;
}

double log_likelihood(std::span<const LevelCount> counts, const Psychometric& function) {
    double sum = 0.0;
    for (const LevelCount& count : counts) {
        const double p = std::clamp(function.at(count.level), 1e-15, 1.0 - 1e-15);
        sum += count.correct * std::log(p) + (count.trials - count.correct) * std::log1p(-p);
    }
    return sum;
}

PsychometricFit fit_psychometric(std::span<const LevelCount> counts, const FitSettings& settings) {
    if (counts.empty()) throw Error("a psychometric fit needs answers");
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const LevelCount& count : counts) {
        if (!(count.trials > 0.0 && count.correct >= 0.0 && count.correct <= count.trials &&
              std::isfinite(count.level)))
            throw Error("a psychometric fit needs finite levels, and 0 to n correct answers of n at each");
        low = std::min(low, count.level);
        high = std::max(high, count.level);
    }
    if (!(high > low) && !settings.slope) throw Error("a psychometric fit with a free slope needs at least two levels");
    const double span = std::max(high - low, 1e-3);
    const Objective objective(counts, settings);
    Vertex best{{}, std::numeric_limits<double>::infinity()};
    Place reach{0.05 * span, 0.3, 0.2};
    for (int t = 0; t <= 20; ++t)
        for (int w = 0; w < (objective.has_slope() ? 7 : 1); ++w) {
            Place x{low + span * (-0.1 + 1.2 * t / 20.0)};
            std::size_t next = 1;
            if (objective.has_slope()) x[next++] = std::log(slope_of_width(settings.form, span * std::pow(2.0, -w)));
            if (objective.has_lapse()) x[next] = 0.4;
            if (const double value = objective(x); value < best.value) best = {x, value};
        }
    if (!objective.has_slope()) reach[1] = 0.2;
    // A second search from the result leaves a simplex that has collapsed early.
    for (const double scale : {1.0, 0.3, 0.1}) {
        Place step = reach;
        for (double& s : step) s *= scale;
        best = nelder_mead(objective, best.x, step);
    }
    PsychometricFit fit;
    fit.function = objective.function(best.x);
    fit.log_likelihood = -best.value;
    fit.deviance = 2.0 * (saturated_likelihood(counts) - fit.log_likelihood);
    // As the threshold goes to either infinity, P becomes a constant: guess, or 1 − lapse. Where the answers do not exclude
    // both, its likelihood interval has no end there. Half of 3.84 is the 5 % limit of a likelihood ratio.
    constexpr double limit = 1.92;
    double trials = 0.0, correct = 0.0;
    for (const LevelCount& count : counts) {
        trials += count.trials;
        correct += count.correct;
    }
    const auto excludes = [&](double p) {
        p = std::clamp(p, 1e-15, 1.0 - 1e-15);
        return fit.log_likelihood - correct * std::log(p) - (trials - correct) * std::log1p(-p) > limit;
    };
    const double lapse = settings.lapse.value_or(std::clamp(1.0 - correct / trials, 0.0, settings.max_lapse));
    fit.is_identified = excludes(settings.guess) && excludes(1.0 - lapse);
    return fit;
}

BootstrapIntervals bootstrap_fit(std::span<const LevelCount> counts, const FitSettings& settings,
                                 const PsychometricFit& fit, double p, int samples, double confidence,
                                 std::uint64_t seed) {
    const Random random{seed};
    std::uint64_t index = 0;
    std::vector<double> thresholds, slopes;
    BootstrapIntervals result;
    int worse = 0;
    std::vector<LevelCount> drawn(counts.begin(), counts.end());
    for (int sample = 0; sample < samples; ++sample) {
        for (LevelCount& count : drawn) {
            const double probability = fit.function.at(count.level);
            count.correct = 0.0;
            for (double trial = 0.5; trial < count.trials; trial += 1.0)
                count.correct += random.uniform(index++) < probability ? 1.0 : 0.0;
        }
        const PsychometricFit again = fit_psychometric(drawn, settings);
        if (again.deviance >= fit.deviance) ++worse;
        const double threshold = again.function.level_of(p);
        if (!again.is_identified || !std::isfinite(threshold)) {
            ++result.failed;
            continue;
        }
        thresholds.push_back(threshold);
        slopes.push_back(again.function.slope);
    }
    if (thresholds.size() < 2 || thresholds.size() * 2 < static_cast<std::size_t>(samples))
        throw Error("more than half of the bootstrap samples cannot be fitted: there are too few answers");
    std::ranges::sort(thresholds);
    std::ranges::sort(slopes);
    const double tail = 0.5 - 0.5 * confidence;
    result.threshold = {percentile_of(thresholds, tail), percentile_of(thresholds, 1.0 - tail)};
    result.slope = {percentile_of(slopes, tail), percentile_of(slopes, 1.0 - tail)};
    result.deviance_p = static_cast<double>(worse + 1) / static_cast<double>(samples + 1);
    return result;
}

}  // namespace tactus::psychophysics

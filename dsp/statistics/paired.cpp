// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/paired.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/statistics/distributions.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

namespace tactus::statistics {

namespace {

constexpr std::size_t max_exact = 20;

void check_differences(std::span<const double> differences) {
    if (differences.size() < 2) throw Error("a paired test needs at least two subjects");
    if (!std::ranges::all_of(differences, [](double d) { return std::isfinite(d); }))
        throw Error("a difference is not a finite number");
}

Moments varying_moments(std::span<const double> differences) {
    check_differences(differences);
    const Moments of = moments(differences);
    // Differences that are equal but for rounding have a deviation that is rounding alone.
    const auto [low, high] = std::ranges::minmax(differences);
    if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high))) || !(of.deviation > 0.0))
        throw Error("all differences are equal: no test is possible");
    return of;
}

}  // namespace

Moments moments(std::span<const double> values) {
    Moments result{values.size(), 0.0, 0.0};
    if (values.empty()) return result;
    const double n = static_cast<double>(values.size());
    result.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    if (values.size() < 2) return result;
    double sum = 0.0;
    for (const double value : values) sum += (value - result.mean) * (value - result.mean);
    result.deviation = std::sqrt(sum / (n - 1.0));
    return result;
}

PairedTest paired_t(std::span<const double> differences, double confidence) {
    PairedTest test;
    test.of = varying_moments(differences);
    const double n = static_cast<double>(differences.size()), error = test.of.deviation / std::sqrt(n);
    test.freedom = n - 1.0;
    test.t = test.of.mean / error;
    test.p = student_two_sided(test.t, test.freedom);
    const double reach = error * student_quantile(0.5 + 0.5 * confidence, test.freedom);
    test.low = test.of.mean - reach;
    test.high = test.of.mean + reach;
    return test;
}

PermutationTest permutation_test(std::span<const double> differences, std::uint64_t seed, std::uint64_t draws) {
    check_differences(differences);
    const std::size_t n = differences.size();
    double observed = 0.0, size = 0.0;
    for (const double d : differences) {
        observed += d;
        size += std::abs(d);
    }
    // Sums that differ by rounding only are ties.
    const double limit = std::abs(observed) - 1e-12 * size;
    PermutationTest test;
    std::uint64_t extreme = 0;
    if (n <= max_exact) {
        test.is_exact = true;
        test.arrangements = std::uint64_t{1} << n;
        // The first sign stays: the mirrored arrangement has the same absolute sum. A Gray code changes one sign a step.
        std::uint32_t code = 0;
        double sum = observed;
        for (std::uint64_t i = 0; i < test.arrangements / 2; ++i) {
            if (i > 0) {
                const auto place = static_cast<std::size_t>(std::countr_zero(i));
                code ^= std::uint32_t{1} << place;
                const double d = differences[place + 1];
                sum += (code >> place & 1U) != 0 ? -2.0 * d : 2.0 * d;
            }
            if (std::abs(sum) >= limit) extreme += 2;
        }
        test.p = static_cast<double>(extreme) / static_cast<double>(test.arrangements);
        return test;
    }
    test.arrangements = draws;
    const Random random{seed};
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
        double sum = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint64_t index = draw * n + i;
            sum += (random.bits(index / 64) >> index % 64 & 1U) != 0 ? differences[i] : -differences[i];
        }
        if (std::abs(sum) >= limit) ++extreme;
    }
    test.p = static_cast<double>(extreme + 1) / static_cast<double>(draws + 1);
    return test;
}

std::vector<double> holm(std::span<const double> p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> adjusted(p.size());
    double greatest = 0.0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        greatest = std::max(greatest, static_cast<double>(p.size() - rank) * p[order[rank]]);
        adjusted[order[rank]] = std::min(1.0, greatest);
    }
    return adjusted;
}

EquivalenceTest equivalence_test(std::span<const double> differences, double margin, double alpha) {
    if (!(margin > 0.0)) throw Error("the margin of an equivalence test must be positive");
    const Moments of = varying_moments(differences);
    const double n = static_cast<double>(differences.size()), error = of.deviation / std::sqrt(n), freedom = n - 1.0;
    EquivalenceTest test;
    const double above = student_cdf(-(of.mean + margin) / error, freedom),
                 below = student_cdf((of.mean - margin) / error, freedom);
    test.p = std::max(above, below);
    const double reach = error * student_quantile(1.0 - alpha, freedom);
    test.low = of.mean - reach;
    test.high = of.mean + reach;
    if (test.low > -margin && test.high < margin) test.verdict = Equivalence::equivalent;
    else if (test.low > margin || test.high < -margin) test.verdict = Equivalence::different;
    return test;
}

EquivalenceTest standardised_equivalence(std::span<const double> differences, double margin, double alpha) {
    if (!(margin > 0.0)) throw Error("the margin of an equivalence test must be positive");
    const Moments of = varying_moments(differences);
    const double root = std::sqrt(static_cast<double>(differences.size()));
    const double freedom = static_cast<double>(differences.size()) - 1.0, t = root * of.mean / of.deviation;
    const double size = std::abs(t), shift = margin * root;
    const double below = noncentral_student_cdf(size, freedom, shift);
    EquivalenceTest test;
    test.p = below - noncentral_student_cdf(-size, freedom, shift);
    if (test.p < alpha) test.verdict = Equivalence::equivalent;
    else if (1.0 - below < alpha) test.verdict = Equivalence::different;
    return test;
}

std::pair<double, double> standardised_interval(std::span<const double> differences, double confidence) {
    const Moments of = varying_moments(differences);
    const double root = std::sqrt(static_cast<double>(differences.size()));
    const double freedom = static_cast<double>(differences.size()) - 1.0, t = root * of.mean / of.deviation;
    const auto effect_at = [&](double wanted) {
        // The noncentrality that gives t scatters by 1 / sqrt(2 freedom) of t.
        const double reach = 20.0 + std::abs(t) * (1.0 + 12.0 / std::sqrt(2.0 * freedom));
        double low = t - reach, high = t + reach;
        for (int step = 0; step < 60; ++step) {
            const double middle = 0.5 * (low + high);
            (noncentral_student_cdf(t, freedom, middle) > wanted ? low : high) = middle;
        }
        return 0.5 * (low + high) / root;
    };
    return {effect_at(0.5 + 0.5 * confidence), effect_at(0.5 - 0.5 * confidence)};
}

double power_of_standardised_equivalence(std::size_t subjects, double margin, double effect, double alpha) {
    const double root = std::sqrt(static_cast<double>(subjects)), freedom = static_cast<double>(subjects) - 1.0;
    double low = 0.0, high = margin * root + 20.0;
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        const double size = noncentral_student_cdf(middle, freedom, margin * root) -
                            noncentral_student_cdf(-middle, freedom, margin * root);
        (size < alpha ? low : high) = middle;
    }
    return noncentral_student_cdf(low, freedom, effect * root) - noncentral_student_cdf(-low, freedom, effect * root);
}

CrossOver cross_over(std::span<const double> differences, const std::vector<bool>& b_second, double confidence) {
    check_differences(differences);
    std::array<std::vector<double>, 2> groups;
    for (std::size_t i = 0; i < differences.size(); ++i) groups[b_second[i] ? 1 : 0].push_back(differences[i]);
    if (groups[0].empty() || groups[1].empty() || differences.size() < 3)
        throw Error("a cross-over needs a subject in each order, and three in all");
    const Moments first = moments(groups[0]), second = moments(groups[1]);
    const double n0 = static_cast<double>(first.count), n1 = static_cast<double>(second.count);
    CrossOver result;
    result.freedom = n0 + n1 - 2.0;
    const double variance =
        ((n0 - 1.0) * first.deviation * first.deviation + (n1 - 1.0) * second.deviation * second.deviation) /
        result.freedom;
    if (!(variance > 1e-24 * std::max(first.mean * first.mean, second.mean * second.mean)))
        throw Error("all differences of an order are equal: no test is possible");
    // Half sum and half difference of two means have the same standard error.
    const double error = 0.5 * std::sqrt(variance * (1.0 / n0 + 1.0 / n1));
    result.effect = 0.5 * (second.mean + first.mean);
    result.period = 0.5 * (second.mean - first.mean);
    result.p = student_two_sided(result.effect / error, result.freedom);
    result.period_p = student_two_sided(result.period / error, result.freedom);
    const double reach = error * student_quantile(0.5 + 0.5 * confidence, result.freedom);
    result.low = result.effect - reach;
    result.high = result.effect + reach;
    return result;
}

double power_of_test(std::size_t subjects, double effect, double alpha) {
    const double n = static_cast<double>(subjects), freedom = n - 1.0,
                 limit = student_quantile(1.0 - 0.5 * alpha, freedom);
    const double shift = effect * std::sqrt(n);
    return 1.0 - noncentral_student_cdf(limit, freedom, shift) + noncentral_student_cdf(-limit, freedom, shift);
}

double detectable_effect(std::size_t subjects, double power, double alpha) {
    if (subjects < 2) throw Error("power needs at least two subjects");
    double low = 0.0, high = 1.0;
    while (power_of_test(subjects, high, alpha) < power) high *= 2.0;
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (power_of_test(subjects, middle, alpha) < power ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double power_of_equivalence(std::size_t subjects, double margin, double effect, double alpha) {
    const double root = std::sqrt(static_cast<double>(subjects)), freedom = static_cast<double>(subjects) - 1.0;
    const double limit = student_quantile(1.0 - alpha, freedom);
    return mean_over_deviation(freedom, [&](double s) {
        const double reach = limit * s;  // in standard errors
        return std::max(0.0,
                        normal_cdf((margin - effect) * root - reach) - normal_cdf((-margin - effect) * root + reach));
    });
}

}  // namespace tactus::statistics

// SPDX-License-Identifier: Apache-2.0
#include "dsp/psychophysics/fit.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/psychophysics/detection.hpp"
#include "dsp/statistics/distributions.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;
using namespace tactus::psychophysics;

namespace {

std::vector<LevelCount> simulated(const Psychometric& truth, std::initializer_list<double> levels, int trials,
                                  std::uint64_t seed) {
    const Random random{seed};
    std::vector<LevelCount> counts;
    std::uint64_t index = 0;
    for (const double level : levels) {
        LevelCount count{level, static_cast<double>(trials), 0.0};
        for (int i = 0; i < trials; ++i) count.correct += random.uniform(index++) < truth.at(level) ? 1.0 : 0.0;
        counts.push_back(count);
    }
    return counts;
}

}  // namespace

TEST_CASE("a psychometric function has its threshold, its borders and its inverse") {
    for (const Form form : {Form::logistic, Form::weibull, Form::normal}) {
        const Psychometric f{form, 0.3, 2.5, 0.25, 0.04};
        CHECK(f.core(0.3) == Approx(form == Form::weibull ? 1.0 - std::exp(-1.0) : 0.5));
        CHECK(f.at(-100.0) == Approx(0.25));
        CHECK(f.at(100.0) == Approx(0.96));
        for (const double p : {0.3, 0.5, 0.75, 0.95}) CHECK(f.at(f.level_of(p)) == Approx(p));
        CHECK(std::isnan(f.level_of(0.2)));
        CHECK(std::isnan(f.level_of(0.97)));
    }
}

TEST_CASE("the fit of exact probabilities returns the function that made them") {
    for (const Form form : {Form::logistic, Form::weibull, Form::normal}) {
        const Psychometric truth{form, -0.137, 4.2, 0.5, 0.03};
        std::vector<LevelCount> counts;
        for (double level = -1.0; level <= 0.81; level += 0.1) counts.push_back({level, 1e5, 1e5 * truth.at(level)});
        const PsychometricFit fit = fit_psychometric(counts, {form, 0.5, {}, 0.1, {}, 1e-2, 1e3});
        CHECK(fit.function.threshold == Approx(truth.threshold).epsilon(1e-5));
        CHECK(fit.function.slope == Approx(truth.slope).epsilon(1e-4));
        CHECK(fit.function.lapse == Approx(0.03).epsilon(1e-3));
        CHECK(fit.deviance < 1e-4);
        CHECK(fit.is_identified);
    }
}

TEST_CASE("no point near a fit is more likely") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto counts = simulated({Form::weibull, 0.1, 3.0, 0.5, 0.02}, {-0.5, -0.2, 0.0, 0.2, 0.4, 0.8}, 30, seed);
        const PsychometricFit fit = fit_psychometric(counts, {});
        CHECK(fit.log_likelihood == Approx(log_likelihood(counts, fit.function)));
        const Random random{seed};
        for (std::uint64_t i = 0; i < 200; ++i) {
            Psychometric other = fit.function;
            other.threshold += 0.02 * random.normal(3 * i);
            other.slope *= std::exp(0.1 * random.normal(3 * i + 1));
            other.lapse = std::clamp(other.lapse + 0.01 * random.normal(3 * i + 2), 0.0, 0.1);
            CHECK(log_likelihood(counts, other) <= fit.log_likelihood + 1e-8);
        }
    }
}

TEST_CASE("a fit that the answers do not determine is marked") {
    const std::vector<LevelCount> all_right{{-0.5, 20, 20}, {0.0, 20, 20}, {0.5, 20, 20}};
    const std::vector<LevelCount> chance{{-0.5, 20, 10}, {0.0, 20, 10}, {0.5, 20, 10}};
    CHECK_FALSE(fit_psychometric(all_right, {}).is_identified);
    CHECK_FALSE(fit_psychometric(chance, {}).is_identified);
    CHECK_THROWS_AS(fit_psychometric({}, {}), Error);
    CHECK_THROWS_AS(fit_psychometric(std::vector<LevelCount>{{0.0, 10, 11}, {1.0, 10, 5}}, {}), Error);
    CHECK_THROWS_AS(fit_psychometric(std::vector<LevelCount>{{0.0, 10, 8}}, {}), Error);
    CHECK_THROWS_AS(fit_psychometric(std::vector<LevelCount>{{std::nan(""), 10, 8}, {1.0, 10, 5}}, {}), Error);
}

TEST_CASE("single trials are counted by level") {
    const std::vector<double> levels{0.5, -1.0, 0.5, 0.5};
    const auto counts = count_levels(levels, {true, false, false, true});
    REQUIRE(counts.size() == 2);
    CHECK(counts[0].level == -1.0);
    CHECK(counts[1].trials == 3.0);
    CHECK(counts[1].correct == 2.0);
}

// Costly: 200 fits with 199 fits each.
TEST_CASE("bootstrap intervals of constant stimuli cover the threshold", "[long]") {
    const Psychometric truth{Form::weibull, 0.05, 3.0, 0.5, 0.02};
    FitSettings settings;
    settings.lapse = 0.02;
    const double p = 0.75, wanted = truth.level_of(p);
    int covered = 0;
    constexpr int runs = 200;
    for (int run = 0; run < runs; ++run) {
        const auto counts = simulated(truth, {-0.4, -0.2, 0.0, 0.2, 0.4}, 60, 300 + static_cast<std::uint64_t>(run));
        const PsychometricFit fit = fit_psychometric(counts, settings);
        const auto interval = bootstrap_fit(counts, settings, fit, p, 199).threshold;
        if (interval.low <= wanted && wanted <= interval.high) ++covered;
    }
    // 92 to 97 %, and three standard errors of 200 runs.
    CHECK(covered / double{runs} > 0.92 - 0.045);
    CHECK(covered / double{runs} <= 1.0);
}

TEST_CASE("sensitivity of a yes or no task is that of the normal distributions") {
    // 69.1 % hits and 30.9 % false alarms: d′ = 1, no bias; with many trials the correction vanishes.
    const Detection even = yes_no(691'462, 1'000'000, 308'538, 1'000'000);
    CHECK(even.d_prime == Approx(1.0).epsilon(1e-4));
    CHECK(even.criterion == Approx(0.0).margin(1e-4));
    CHECK(std::isfinite(yes_no(20, 20, 0, 20).d_prime));
    CHECK(yes_no(5, 20, 1, 20).criterion > 0.0);
    CHECK_THROWS_AS(yes_no(1, 0, 0, 10), Error);
    CHECK_THROWS_AS(yes_no(11, 10, 0, 10), Error);
}

TEST_CASE("sensitivity of choices has its closed forms and the values of brute force") {
    CHECK(d_prime_of_choice(0.76, 2) == Approx(std::numbers::sqrt2 * statistics::normal_quantile(0.76)));
    CHECK(correct_of_choice(0.0, 3) == Approx(1.0 / 3.0));
    CHECK(correct_of_choice(0.0, 8) == Approx(0.125));
    CHECK(d_prime_of_choice(correct_of_choice(1.3, 4), 4) == Approx(1.3));
    // Brute force: how often the signal is the largest of m draws; four standard errors.
    const Random random{3};
    for (const int m : {3, 5}) {
        constexpr int draws = 50'000;
        int largest = 0;
        for (std::uint64_t i = 0; i < draws; ++i) {
            const double signal = 0.9 + random.normal(10 * i);
            bool is_largest = true;
            for (int other = 1; other < m; ++other)
                is_largest = is_largest && random.normal(10 * i + static_cast<std::uint64_t>(other)) < signal;
            largest += is_largest ? 1 : 0;
        }
        CHECK(correct_of_choice(0.9, m) == Approx(largest / double{draws}).margin(0.009));
    }
    CHECK(d_prime_of_choice(0.1, 4) == 0.0);
    CHECK_THROWS_AS(d_prime_of_choice(1.0, 2), Error);
    const double d = d_prime_of_same_different(0.7);
    const double up = statistics::normal_cdf(0.5 * d), down = statistics::normal_cdf(-0.5 * d);
    CHECK(up * up + down * down == Approx(0.7));
    CHECK(d_prime_of_same_different(0.4) == 0.0);
}

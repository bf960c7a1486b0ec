// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/prediction/burg.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/prediction/line_frequencies.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

/// a₁ … of resonances at these angles and radii.
std::vector<double> resonator(const std::vector<std::pair<double, double>>& poles) {
    std::vector<double> a{1.0};
    for (const auto& [angle, radius] : poles) {
        std::vector<double> next(a.size() + 2, 0.0);
        for (std::size_t i = 0; i < a.size(); ++i) {
            next[i] += a[i];
            next[i + 1] -= 2.0 * radius * std::cos(angle) * a[i];
            next[i + 2] += radius * radius * a[i];
        }
        a = next;
    }
    return {a.begin() + 1, a.end()};
}

std::vector<double> noise_through(const std::vector<double>& a, std::size_t count) {
    const Random random{42};
    std::vector<double> y(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        y[i] = random.normal(i);
        for (std::size_t k = 0; k < a.size() && k < i; ++k) y[i] -= a[k] * y[i - 1 - k];
    }
    return y;
}

}  // namespace

TEST_CASE("Burg's method finds the filter that shaped a noise") {
    const auto a = resonator({{0.3, 0.95}, {1.1, 0.9}, {2.0, 0.8}});
    const auto y = noise_through(a, 200000);
    const auto reflection = signal::burg(y, a.size());
    std::vector<double> found(a.size());
    signal::predictor_of(reflection, found);
    for (std::size_t i = 0; i < a.size(); ++i) CHECK(found[i] == Approx(a[i]).margin(0.02));
    // The gain of that filter: the mean square of the output for noise of mean square 1.
    double power = 0.0;
    for (const double x : y) power += x * x / static_cast<double>(y.size());
    CHECK(signal::prediction_gain(reflection) == Approx(power).epsilon(0.02));
}

TEST_CASE("one reflection coefficient of Burg's method is -2 sum(f b) / sum(f^2 + b^2)") {
    const std::vector<double> x{1.0, 2.0, -1.0, 0.5, 3.0};
    // f = x[1..4], b = x[0..3]
    const double product = 2.0 - 2.0 - 0.5 + 1.5, power = (4.0 + 1.0 + 0.25 + 9.0) + (1.0 + 4.0 + 1.0 + 0.25);
    CHECK(signal::burg(x, 1).front() == Approx(-2.0 * product / power));
}

TEST_CASE("a silent record has a flat predictor, and one that is too short is refused") {
    const std::vector<double> silence(100, 0.0);
    for (const double k : signal::burg(silence, 8)) CHECK(k == 0.0);
    CHECK_THROWS_AS(signal::burg(std::span(silence).first(16), 8), Error);
}

TEST_CASE("reflection coefficients and predictors are each other's inverse") {
    const Random random{7};
    for (std::uint64_t round = 0; round < 50; ++round) {
        std::vector<double> reflection(36), predictor(36);
        for (std::size_t i = 0; i < reflection.size(); ++i)
            reflection[i] = 1.6 * (random.uniform(round * 100 + i) - 0.5);
        signal::predictor_of(reflection, predictor);
        REQUIRE(signal::reflection_of(predictor));
        for (std::size_t i = 0; i < reflection.size(); ++i) CHECK(predictor[i] == Approx(reflection[i]).margin(1e-9));
    }
    std::vector<double> unstable{0.0, 1.01};
    CHECK_FALSE(signal::reflection_of(unstable));
}

TEST_CASE("line frequencies give the predictor back") {
    const Random random{8};
    for (std::uint64_t round = 0; round < 50; ++round) {
        std::vector<double> reflection(36), predictor(36), back(36);
        for (std::size_t i = 0; i < reflection.size(); ++i)
            reflection[i] = 1.4 * (random.uniform(round * 100 + i) - 0.5);
        signal::predictor_of(reflection, predictor);
        const auto lines = signal::line_frequencies(predictor);
        REQUIRE(lines.size() == 36);
        CHECK(lines.front() > 0.0);
        CHECK(lines.back() < pi);
        CHECK(std::ranges::is_sorted(lines));
        signal::predictor_of_lines(lines, back);
        const double scale = std::abs(*std::ranges::max_element(predictor, {}, [](double a) { return std::abs(a); }));
        for (std::size_t i = 0; i < predictor.size(); ++i) CHECK(back[i] == Approx(predictor[i]).margin(1e-8 * scale));
    }
}

TEST_CASE("the line frequencies of a flat predictor are evenly spaced") {
    const std::vector<double> flat(8, 0.0);
    const auto lines = signal::line_frequencies(flat);
    for (std::size_t i = 0; i < lines.size(); ++i) CHECK(lines[i] == Approx(pi * static_cast<double>(i + 1) / 9.0));
}

TEST_CASE("means of the line frequencies of stable filters belong to stable filters, means of predictors need not") {
    const Random random{9};
    for (std::uint64_t round = 0; round < 200; ++round) {
        std::vector<double> lines[2];
        for (std::size_t which = 0; which < 2; ++which) {
            std::vector<double> reflection(12), predictor(12);
            for (std::size_t i = 0; i < reflection.size(); ++i)
                reflection[i] = 1.98 * (random.uniform(round * 1000 + which * 100 + i) - 0.5);
            signal::predictor_of(reflection, predictor);
            lines[which] = signal::line_frequencies(predictor);
        }
        std::vector<double> mean(12), predictor(12);
        const double x = random.uniform(round * 1000 + 999);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = lines[0][i] + x * (lines[1][i] - lines[0][i]);
        signal::predictor_of_lines(mean, predictor);
        REQUIRE(signal::reflection_of(predictor));
    }
}

TEST_CASE("only a stable predictor of even order has line frequencies") {
    CHECK_THROWS_AS(signal::line_frequencies(std::vector<double>{0.5, 0.1, 0.2}), Error);
    CHECK_THROWS_AS(signal::line_frequencies(std::vector<double>{0.0, 1.1}), Error);
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/carry_over.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/statistics/orders.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <vector>

using namespace tactus;
using namespace tactus::statistics;

namespace {

constexpr double mode_effect = 2.0, mode_left_behind = 0.7;
// Treatment 2 display + mode; weights of the mode, averaged over displays.
const std::vector<double> mode_contrast{-0.5, 0.5, -0.5, 0.5};

/// The co-location study: both modes of one display, then of the other.
std::vector<PeriodValue> co_location_values(std::size_t subjects, double noise, std::uint64_t seed,
                                            double left_behind = mode_left_behind) {
    const Random random{seed};
    std::vector<PeriodValue> values;
    for (std::size_t subject = 0; subject < subjects; ++subject) {
        const auto periods = co_location_row(subject).periods();
        for (std::size_t period = 0; period < 4; ++period) {
            const auto [display, mode] = periods[period];
            PeriodValue one{subject, period, 2 * display + mode, 0.0, 0.0};
            if (period > 0) one.carried = periods[period - 1][1] == 1 ? 0.5 : -0.5;
            one.value = 5.0 * random.normal(subject) + 0.3 * static_cast<double>(period) +
                        1.5 * static_cast<double>(display) + mode_effect * static_cast<double>(mode) +
                        left_behind * one.carried + noise * random.normal(1000 + 4 * subject + period);
            values.push_back(one);
        }
    }
    return values;
}

}  // namespace

TEST_CASE("carry-over widens the variance of the mode effect of 16 subjects by 57 percent") {
    const CarryOver result = carry_over(co_location_values(16, 1.0, 1), mode_contrast);
    CHECK(result.variance_factor == Approx(11.0 / 7.0).epsilon(1e-9));
    CHECK(result.freedom == 64.0 - 16.0 - 3.0 - 3.0 - 1.0);
    // The design alone decides: other numbers give the same.
    CHECK(carry_over(co_location_values(16, 9.0, 2), mode_contrast).variance_factor == Approx(result.variance_factor));
}

TEST_CASE("an effect and what it leaves behind are told apart") {
    const CarryOver result = carry_over(co_location_values(16, 1e-3, 3), mode_contrast);
    CHECK(result.effect == Approx(mode_effect).margin(2e-3));
    CHECK(result.carried == Approx(mode_left_behind).margin(2e-3));
    CHECK(result.low < mode_effect);
    CHECK(result.high > mode_effect);
    CHECK(result.p < 1e-6);
    CHECK(result.carried_p < 1e-6);
}

TEST_CASE("a model without carry-over is biased where there is some, and this one is not") {
    double with = 0.0, without = 0.0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const std::vector<PeriodValue> values = co_location_values(16, 0.5, 100 + seed, 2.0);
        with += carry_over(values, mode_contrast).effect / 60.0;
        for (const PeriodValue& one : values)
            without += (one.treatment % 2 == 1 ? 1.0 : -1.0) * one.value / 32.0 / 60.0;
    }
    CHECK(with == Approx(mode_effect).margin(0.1));
    CHECK(std::abs(without - mode_effect) > 0.3);
}

TEST_CASE("intervals adjusted for carry-over cover as stated, and its test keeps its size", "[slow]") {
    int covered = 0, positives = 0;
    constexpr int studies = 1500;
    for (int study = 0; study < studies; ++study) {
        const CarryOver result =
            carry_over(co_location_values(16, 1.0, 5000 + static_cast<std::uint64_t>(study), 0.0), mode_contrast);
        covered += result.low <= mode_effect && mode_effect <= result.high ? 1 : 0;
        positives += result.carried_p < 0.05 ? 1 : 0;
    }
    // Three and a half standard errors.
    CHECK(covered / double{studies} == Approx(0.95).margin(0.02));
    CHECK(positives / double{studies} == Approx(0.05).margin(0.02));
}

TEST_CASE("designs that cannot separate carry-over are refused") {
    std::vector<PeriodValue> same;  // A always before B
    for (std::size_t subject = 0; subject < 8; ++subject)
        for (std::size_t period = 0; period < 2; ++period)
            same.push_back({subject, period, period, std::sin(1.0 + static_cast<double>(3 * subject + period)),
                            period == 1 ? -0.5 : 0.0});
    CHECK_THROWS_WITH(carry_over(same, {-1.0, 1.0}), Catch::Matchers::ContainsSubstring("do not separate"));
    CHECK_THROWS_AS(carry_over(std::vector<PeriodValue>{}, {-1.0, 1.0}), Error);
    std::vector<PeriodValue> broken = co_location_values(16, 1.0, 1);
    broken[3].value = std::nan("");
    CHECK_THROWS_AS(carry_over(broken, mode_contrast), Error);
}

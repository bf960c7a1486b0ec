// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/paired.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/statistics/distributions.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace tactus;
using namespace tactus::statistics;

namespace {

std::vector<double> normal_sample(std::size_t n, double mean, double deviation, std::uint64_t seed) {
    const Random random{seed};
    std::vector<double> sample;
    for (std::size_t i = 0; i < n; ++i) sample.push_back(mean + deviation * random.normal(i));
    return sample;
}

/// Every arrangement of signs, added up anew.
double permutation_p_by_force(const std::vector<double>& d) {
    double observed = 0.0;
    for (const double x : d) observed += x;
    int extreme = 0;
    const int all = 1 << d.size();
    for (int code = 0; code < all; ++code) {
        double sum = 0.0;
        for (std::size_t i = 0; i < d.size(); ++i) sum += (code >> i & 1) != 0 ? -d[i] : d[i];
        if (std::abs(sum) >= std::abs(observed) - 1e-9) ++extreme;
    }
    return static_cast<double>(extreme) / all;
}

}  // namespace

TEST_CASE("a paired t test repeats the sleep data of Student") {
    // Extra sleep after two drugs (Student 1908): t = 4.0621, p = 0.002833, interval 0.7001 to 2.4599.
    const std::vector<double> differences{1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4};
    const PairedTest test = paired_t(differences);
    CHECK(test.t == Approx(4.0621).epsilon(1e-4));
    CHECK(test.p == Approx(0.002833).epsilon(1e-3));
    CHECK(test.low == Approx(0.7001142).epsilon(1e-6));
    CHECK(test.high == Approx(2.4598858).epsilon(1e-6));
    CHECK(test.freedom == 9.0);
}

TEST_CASE("differences that are equal but for rounding are not tested") {
    for (const double value : {0.1, 0.3, -7.7, 1e9 / 3.0})
        for (std::size_t n = 3; n <= 16; ++n) {
            CAPTURE(value, n);
            CHECK_THROWS_AS(paired_t(std::vector<double>(n, value)), Error);
        }
}

TEST_CASE("the ends of a standardised interval leave the stated tails, also for large effects") {
    for (const std::vector<double>& d :
         {std::vector{1.0, 1.01, 0.99, 1.02}, std::vector{-3.0, -3.02, -3.01, -2.98, -3.0, -3.03},
          std::vector{0.3, -0.2, 0.5, 0.1, 0.0}}) {
        const Moments of = moments(d);
        const double root = std::sqrt(static_cast<double>(d.size())), t = root * of.mean / of.deviation;
        const auto [low, high] = standardised_interval(d, 0.9);
        CHECK(noncentral_student_cdf(t, static_cast<double>(d.size()) - 1.0, low * root) == Approx(0.95).margin(1e-4));
        CHECK(noncentral_student_cdf(t, static_cast<double>(d.size()) - 1.0, high * root) == Approx(0.05).margin(1e-4));
    }
}

TEST_CASE("tests of differences refuse what they cannot test") {
    CHECK_THROWS_AS(paired_t(std::vector{1.0}), Error);
    CHECK_THROWS_AS(paired_t(std::vector{1.0, 1.0, 1.0}), Error);
    CHECK_THROWS_AS(paired_t(std::vector{1.0, std::numeric_limits<double>::quiet_NaN()}), Error);
    CHECK_THROWS_AS(equivalence_test(std::vector{1.0, 2.0}, 0.0), Error);
    CHECK_THROWS_AS(equivalence_test(std::vector{1.0, 2.0}, std::numeric_limits<double>::quiet_NaN()), Error);
    CHECK_THROWS_AS(cross_over(std::vector{1.0, 2.0, 3.0}, {true, true, true}), Error);
    CHECK_THROWS_AS(permutation_test(std::vector{std::numeric_limits<double>::infinity(), 1.0}), Error);
}

TEST_CASE("an exact permutation test counts all arrangements as brute force does") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const std::vector<double> d = normal_sample(2 + seed % 9, 0.4, 1.0, seed);
        const PermutationTest test = permutation_test(d);
        CHECK(test.is_exact);
        CHECK(test.p == Approx(permutation_p_by_force(d)).epsilon(1e-12));
    }
    // Differences with ties and zeros.
    const std::vector<double> tied{1.0, 1.0, 0.0, -1.0, 2.0, 2.0};
    CHECK(permutation_test(tied).p == Approx(permutation_p_by_force(tied)));
    CHECK(permutation_test(std::vector{0.0, 0.0, 0.0}).p == 1.0);
    CHECK(permutation_test(std::vector<double>(10, 0.1)).p == Approx(2.0 / 1024.0));
}

TEST_CASE("a random permutation test agrees with the t test for many subjects and is never zero") {
    const std::vector<double> none = normal_sample(40, 0.05, 1.0, 5), much = normal_sample(40, 3.0, 1.0, 6);
    const PermutationTest test = permutation_test(none);
    CHECK_FALSE(test.is_exact);
    CHECK(test.p == Approx(paired_t(none).p).margin(0.02));
    CHECK(permutation_test(much).p == Approx(1.0 / 20'001.0));
}

TEST_CASE("Holm's adjustment is monotone and stops at one") {
    const std::vector<double> adjusted = holm(std::array{0.01, 0.04, 0.03, 0.005});
    CHECK(adjusted[3] == Approx(0.02));
    CHECK(adjusted[0] == Approx(0.03));
    CHECK(adjusted[2] == Approx(0.06));
    CHECK(adjusted[1] == Approx(0.06));
    CHECK(holm(std::array{0.9, 0.8}) == std::vector<double>{1.0, 1.0});
    CHECK(holm({}).empty());
}

TEST_CASE("equivalence is what the interval of ninety percent shows") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const std::vector<double> d = normal_sample(16, 0.02 * static_cast<double>(seed % 80), 1.0, seed);
        const EquivalenceTest test = equivalence_test(d, 0.9);
        const PairedTest ninety = paired_t(d, 0.9);
        CHECK(test.low == Approx(ninety.low));
        CHECK(test.high == Approx(ninety.high));
        const bool inside = ninety.low > -0.9 && ninety.high < 0.9;
        CHECK((test.verdict == Equivalence::equivalent) == inside);
        CHECK((test.p < 0.05) == inside);
    }
    CHECK(equivalence_test(std::array{5.0, 5.1, 4.9, 5.0}, 0.5).verdict == Equivalence::different);
    CHECK(equivalence_test(std::array{-5.0, 5.1, 4.9, -5.0}, 0.5).verdict == Equivalence::inconclusive);
}

TEST_CASE("equivalence within standard deviations keeps its size at the margin and its power at zero", "[slow]") {
    CHECK(power_of_standardised_equivalence(16, 0.9, 0.9) == Approx(0.05).margin(1e-6));
    CHECK(power_of_standardised_equivalence(16, 0.9) >= 0.9);
    int at_margin = 0, at_zero = 0, covered = 0;
    constexpr int studies = 300;
    for (int study = 0; study < studies; ++study) {
        const std::vector<double> shifted =
            normal_sample(16, 0.9 * 3.0, 3.0, 20'000 + static_cast<std::uint64_t>(study));
        std::vector<double> centred = shifted;
        for (double& d : centred) d -= 0.9 * 3.0;
        const EquivalenceTest far = standardised_equivalence(shifted, 0.9),
                              near = standardised_equivalence(centred, 0.9);
        if (far.verdict == Equivalence::equivalent) ++at_margin;
        if (near.verdict == Equivalence::equivalent) ++at_zero;
        const auto [low, high] = standardised_interval(shifted);
        if (low <= 0.9 && 0.9 <= high) ++covered;
    }
    // Three and a half standard errors.
    CHECK(covered / double{studies} == Approx(0.9).margin(0.06));
    CHECK(at_margin / double{studies} == Approx(0.05).margin(0.044));
    CHECK(at_zero / double{studies} == Approx(power_of_standardised_equivalence(16, 0.9)).margin(0.06));
    CHECK(standardised_equivalence(std::array{5.0, 5.1, 4.9, 5.0}, 0.9).verdict == Equivalence::different);
    CHECK_THROWS_AS(standardised_equivalence(std::array{5.0, 5.1}, 0.0), Error);
}

TEST_CASE("a cross-over separates the effect from the period") {
    // Effect 2, period 0.5: B − A is 2.5 when B came second, 1.5 when it came first; ±0.1 of noise.
    const std::vector<double> d{2.6, 1.4, 2.4, 1.6, 2.5, 1.5, 2.5, 1.5};
    const CrossOver result = cross_over(d, {true, false, true, false, true, false, true, false});
    CHECK(result.effect == Approx(2.0));
    CHECK(result.period == Approx(0.5));
    CHECK(result.freedom == 6.0);
    CHECK(result.period_p < 1e-4);
    CHECK(result.low < 2.0);
    CHECK(result.high > 2.0);
    // The same numbers read as a two-sample t test of the groups: t of the period.
    const double error = std::sqrt(0.04 / 6.0 * (1.0 / 4.0 + 1.0 / 4.0)) / 2.0;
    CHECK(result.high - result.effect == Approx(2.446911851 * error).epsilon(1e-6));
}

TEST_CASE("power has the values of the tables") {
    // G*Power: two-sided paired t, n = 16, dz = 0.75: 0.8005 at most 0.75 needed.
    CHECK(detectable_effect(16) == Approx(0.7493).epsilon(2e-3));
    CHECK(power_of_test(16, detectable_effect(16)) == Approx(0.8).epsilon(1e-9));
    CHECK(power_of_test(16, 0.0) == Approx(0.05).epsilon(1e-6));
    CHECK(power_of_test(34, 0.5) == Approx(0.8078).epsilon(2e-3));
    // 16 subjects show equivalence within 0.9 standard deviations with at least 90 %.
    CHECK(power_of_equivalence(16, 0.9) >= 0.9);
    CHECK(power_of_equivalence(16, 0.5) < 0.3);
    CHECK(power_of_equivalence(16, 0.9, 0.9) == Approx(0.05).margin(0.002));
}

TEST_CASE("simulated studies meet the power that was computed") {
    int found = 0, equivalent = 0;
    constexpr int studies = 2000;
    const double effect = detectable_effect(16);
    for (int study = 0; study < studies; ++study) {
        if (paired_t(normal_sample(16, effect, 1.0, 1000 + study)).p < 0.05) ++found;
        if (equivalence_test(normal_sample(16, 0.0, 1.0, 9000 + study), 0.9).verdict == Equivalence::equivalent)
            ++equivalent;
    }
    // Three standard errors.
    CHECK(found / double{studies} == Approx(0.8).margin(0.027));
    CHECK(equivalent / double{studies} == Approx(power_of_equivalence(16, 0.9)).margin(0.02));
}

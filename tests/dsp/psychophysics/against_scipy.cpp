// SPDX-License-Identifier: Apache-2.0
// Distributions, tests and fits against scipy.
#include "dsp/psychophysics/fit.hpp"
#include "dsp/statistics/distributions.hpp"
#include "dsp/statistics/paired.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::psychophysics;

namespace {

bool has_scipy() { return std::system("/usr/bin/python3 -c 'import numpy, scipy' 2>/dev/null") == 0; }

/// The numbers that a Python program prints.
std::vector<double> numbers_of(const std::string& name, const std::string& program) {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("tactus-{}-{}.py", name, std::rand());
    std::ofstream(file) << program;
    std::vector<double> numbers;
    if (std::FILE* pipe = popen(fmt::format("/usr/bin/python3 '{}'", file.string()).c_str(), "r")) {
        double value = 0.0;
        while (std::fscanf(pipe, "%lf", &value) == 1) numbers.push_back(value);
        CHECK(pclose(pipe) == 0);
    }
    std::filesystem::remove(file);
    return numbers;
}

}  // namespace

TEST_CASE("distributions and tests agree with scipy", "[slow]") {
    if (!has_scipy()) return test::skip("no python3 with numpy and scipy here");
    const Random random{11};
    std::vector<double> d;
    for (std::uint64_t i = 0; i < 16; ++i) d.push_back(0.4 + random.normal(i));
    const std::vector<double> expected = numbers_of("statistics", fmt::format(R"(
from scipy import stats, special
d = [{}]
for t, n in [(-3.1, 4), (0.2, 15), (2.7, 47), (-9.0, 3.5)]:
    print(repr(stats.t.cdf(t, n)))
for p, n in [(0.025, 15), (0.9, 2.5), (1e-6, 30)]:
    print(repr(stats.t.ppf(p, n)))
for a, b, x in [(0.5, 7.5, 0.1), (30, 2, 0.95), (200, 300, 0.4)]:
    print(repr(special.betainc(a, b, x)))
for t, n, s in [(2.13, 15, 3.0), (1.0, 5, -0.5), (-1.0, 31, 0.7)]:
    print(repr(stats.nct.cdf(t, n, s)))
r = stats.ttest_1samp(d, 0)
print(repr(r.statistic), repr(r.pvalue))
print(repr(stats.ttest_1samp(d, -0.9, alternative='greater').pvalue), repr(stats.ttest_1samp(d, 0.9, alternative='less').pvalue))
r = stats.permutation_test((d,), lambda x, axis: x.sum(axis=axis), permutation_type='samples', vectorized=True, n_resamples=1e6)
print(repr(float(r.pvalue)))
)",
                                                                              fmt::join(d, ",")));
    REQUIRE(expected.size() == 18);
    std::size_t next = 0;
    const auto check = [&](double value, double tolerance) {
        CHECK(value == Approx(expected[next]).epsilon(tolerance));
        ++next;
    };
    using namespace statistics;
    check(student_cdf(-3.1, 4), 1e-11);
    check(student_cdf(0.2, 15), 1e-11);
    check(student_cdf(2.7, 47), 1e-11);
    check(student_cdf(-9.0, 3.5), 1e-11);
    check(student_quantile(0.025, 15), 1e-11);
    check(student_quantile(0.9, 2.5), 1e-11);
    check(student_quantile(1e-6, 30), 1e-11);
    check(incomplete_beta(0.5, 7.5, 0.1), 1e-11);
    check(incomplete_beta(30, 2, 0.95), 1e-11);
    check(incomplete_beta(200, 300, 0.4), 1e-10);
    check(noncentral_student_cdf(2.13, 15, 3.0), 1e-7);
    check(noncentral_student_cdf(1.0, 5, -0.5), 1e-7);
    check(noncentral_student_cdf(-1.0, 31, 0.7), 1e-7);
    const PairedTest test = paired_t(d);
    check(test.t, 1e-11);
    check(test.p, 1e-10);
    const double larger = std::max(expected[next], expected[next + 1]);
    CHECK(equivalence_test(d, 0.9).p == Approx(larger).epsilon(1e-10));
    next += 2;
    check(permutation_test(d).p, 1e-9);
}

TEST_CASE("psychometric fits agree with those of scipy", "[slow]") {
    if (!has_scipy()) return test::skip("no python3 with numpy and scipy here");
    // Counts with an interior maximum: 6 levels, 60 trials each.
    const std::vector<double> levels{-0.6, -0.3, -0.1, 0.1, 0.3, 0.7}, trials(6, 60.0), correct{31, 36, 43, 50, 55, 58};
    const std::string program = R"(
import numpy as np
from scipy.optimize import minimize
from scipy.stats import norm
x = np.array([-0.6, -0.3, -0.1, 0.1, 0.3, 0.7]); n = np.full(6, 60.0); k = np.array([31, 36, 43, 50, 55, 58.0])
core = [lambda z: 1/(1+np.exp(-z)), lambda z: -np.expm1(-10**z), norm.cdf]
for f in core:
    def loss(v):
        p = np.clip(0.5 + (0.5 - v[2])*f(np.exp(v[1])*(x - v[0])), 1e-15, 1-1e-15)
        return -(k*np.log(p) + (n-k)*np.log1p(-p)).sum()
    best = min((minimize(loss, [a, b, 0.03], method='L-BFGS-B', bounds=[(-2, 2), (-4, 6), (0, 0.1)], options=dict(ftol=1e-15, gtol=1e-9, maxiter=2000))
                for a in (-0.2, 0.0, 0.2) for b in (0.5, 1.5, 2.5)), key=lambda r: r.fun)
    best = minimize(loss, best.x, method='Nelder-Mead', bounds=[(-2, 2), (-4, 6), (0, 0.1)], options=dict(xatol=1e-9, fatol=1e-13, maxiter=9000, maxfev=9000))
    print(repr(best.x[0]), repr(float(np.exp(best.x[1]))), repr(best.x[2]), repr(-best.fun))
)";
    const std::vector<double> expected = numbers_of("fits", program);
    REQUIRE(expected.size() == 12);
    std::vector<LevelCount> counts;
    for (std::size_t i = 0; i < levels.size(); ++i) counts.push_back({levels[i], trials[i], correct[i]});
    std::size_t next = 0;
    for (const Form form : {Form::logistic, Form::weibull, Form::normal}) {
        FitSettings settings;
        settings.form = form;
        const PsychometricFit fit = fit_psychometric(counts, settings);
        CHECK(fit.function.threshold == Approx(expected[next]).margin(1e-4));
        CHECK(fit.function.slope == Approx(expected[next + 1]).epsilon(1e-4));
        CHECK(fit.function.lapse == Approx(expected[next + 2]).margin(1e-4));
        CHECK(fit.log_likelihood == Approx(expected[next + 3]).margin(1e-6).epsilon(0.0));
        next += 4;
    }
}

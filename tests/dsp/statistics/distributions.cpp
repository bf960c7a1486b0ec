// SPDX-License-Identifier: Apache-2.0
#include "dsp/statistics/distributions.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus::statistics;

TEST_CASE("the normal quantile inverts the distribution into the far tails") {
    for (const double p : {1e-290, 1e-20, 1e-9, 0.001, 0.025, 0.3, 0.5, 0.7, 0.975, 0.999999})
        CHECK(normal_cdf(normal_quantile(p)) == Approx(p).epsilon(1e-12));
    CHECK(normal_quantile(0.975) == Approx(1.959963984540054).epsilon(1e-14));
    CHECK(std::isinf(normal_quantile(0.0)));
    CHECK(std::isinf(normal_quantile(1.0)));
    CHECK(std::isnan(normal_quantile(-0.1)));
}

TEST_CASE("Student's t with one and two degrees of freedom has its closed forms") {
    for (const double t : {-50.0, -2.0, -0.3, 0.0, 0.7, 3.0, 1e4}) {
        CHECK(student_cdf(t, 1.0) == Approx(0.5 + std::atan(t) / std::numbers::pi).epsilon(1e-10).margin(1e-14));
        CHECK(student_cdf(t, 2.0) == Approx(0.5 + t / (2.0 * std::sqrt(2.0 + t * t))).epsilon(1e-10).margin(1e-9));
    }
    // t of the tables.
    CHECK(student_quantile(0.975, 15.0) == Approx(2.131449546).epsilon(1e-9));
    CHECK(student_quantile(0.05, 15.0) == Approx(-1.753050356).epsilon(1e-9));
    CHECK(student_quantile(0.5, 3.0) == 0.0);
    CHECK(student_quantile(0.975, 1e7) == Approx(normal_quantile(0.975)).epsilon(1e-6));
}

TEST_CASE("a two sided p keeps its accuracy where one minus the distribution is zero") {
    CHECK(student_two_sided(40.0, 15.0) > 0.0);
    CHECK(student_two_sided(40.0, 15.0) < 1e-15);
    // 2 P(T > t) for 1 degree of freedom is 2 atan(1/t)/π.
    CHECK(student_two_sided(1e9, 1.0) == Approx(2.0 / (std::numbers::pi * 1e9)).epsilon(1e-9));
}

TEST_CASE("the incomplete beta function has its closed forms and its symmetry") {
    for (const double x : {0.0, 1e-6, 0.2, 0.5, 0.9, 1.0}) {
        CHECK(incomplete_beta(1.0, 1.0, x) == Approx(x).margin(1e-15));
        CHECK(incomplete_beta(3.0, 1.0, x) == Approx(x * x * x).epsilon(1e-12).margin(1e-15));
        for (const double a : {0.5, 2.0, 30.0})
            CHECK(incomplete_beta(a, 4.0, x) + incomplete_beta(4.0, a, 1.0 - x) == Approx(1.0).epsilon(1e-12));
    }
}

TEST_CASE("the mean over a sample's deviation integrates its density to one and its square to one") {
    for (const double freedom : {1.0, 2.0, 3.0, 15.0, 47.0, 300.0}) {
        CHECK(mean_over_deviation(freedom, [](double) { return 1.0; }) == Approx(1.0).epsilon(1e-6));
        CHECK(mean_over_deviation(freedom, [](double s) { return s * s; }) == Approx(1.0).epsilon(1e-6));
    }
}

TEST_CASE("a non-central t without shift is the central one") {
    for (const double t : {-3.0, -0.5, 0.0, 1.0, 2.5})
        CHECK(noncentral_student_cdf(t, 15.0, 0.0) == Approx(student_cdf(t, 15.0)).epsilon(1e-9));
}

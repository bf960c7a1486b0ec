// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/course.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr double rate_of_course = 8000.0;
constexpr double full_turn = 2.0 * std::numbers::pi;

template <class Value>
signal::Course course_of(double seconds, const Value& value) {
    std::vector<double> x(static_cast<std::size_t>(seconds * rate_of_course));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = value(i, static_cast<double>(i) / rate_of_course);
    signal::Course course(rate_of_course, 40.0, 1000.0);
    course.push(x);
    return course;
}

}  // namespace

TEST_CASE("the kurtosis of a course is 1.5 for a sine and 3 for noise") {
    const signal::Course sine = course_of(20.0, [](std::size_t, double t) { return std::sin(full_turn * 233.0 * t); });
    const Random random{3};
    const signal::Course noise = course_of(40.0, [&](std::size_t i, double) { return random.normal(i); });
    CHECK(signal::CourseStatistics(sine.frames()).kurtosis() == Approx(1.5).epsilon(0.01));
    CHECK(signal::CourseStatistics(noise.frames()).kurtosis() == Approx(3.0).epsilon(0.03));
}

TEST_CASE("the depth of modulation is that of the amplitude, in the band of its frequency") {
    for (const auto& [hz, band] : {std::pair{1.0, 2u}, std::pair{4.0, 3u}, std::pair{12.0, 4u}}) {
        const double f = hz;
        const signal::Course course = course_of(20.0, [f](std::size_t, double t) {
            return (1.0 + 0.6 * std::sin(full_turn * f * t)) * std::sin(full_turn * 400.0 * t);
        });
        const signal::CourseStatistics found(course.frames());
        CAPTURE(hz);
        for (std::size_t i = 2; i < 5; ++i)
            CHECK(std::exp(found.values[i]) - 0.05 == Approx(i == band ? 0.6 / std::sqrt(2.0) : 0.0).margin(0.05));
    }
}

TEST_CASE("a course differs from itself by nothing at any gain, and a burst from noise by much") {
    const Random random{5};
    const signal::Course noise = course_of(4.0, [&](std::size_t i, double) { return random.normal(i); });
    const signal::Course softer = course_of(4.0, [&](std::size_t i, double) { return 0.1 * random.normal(i); });
    const signal::Course other = course_of(4.0, [&](std::size_t i, double) { return random.normal(i + 1000000); });
    const signal::Course burst = course_of(
        4.0, [&](std::size_t i, double t) { return (t > 1.0 && t < 2.0 ? 2.0 : 0.01) * random.normal(i + 2000000); });
    CHECK(signal::course_difference_db(noise.frames(), softer.frames()).value() == Approx(0.0).margin(1e-9));
    CHECK(signal::statistics_difference(noise.frames(), other.frames()).value().deviation < 1.0);
    CHECK(signal::course_difference_db(noise.frames(), burst.frames()).value() > 6.0);
    CHECK(signal::statistics_difference(noise.frames(), burst.frames()).value().deviation > 3.0);
    CHECK_FALSE(signal::statistics_difference(noise.frames().first(40), noise.frames()).has_value());
}

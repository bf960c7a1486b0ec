// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/profile.hpp"
#include "tests/support/catch.hpp"

#include <numbers>

using namespace tactus;

namespace {

// The disc sampled on a fine grid, under a normal blur of unit width.
double by_sum(double distance, double radius) {
    double sum = 0.0;
    constexpr double h = 0.02;
    for (double x = -radius + 0.5 * h; x < radius; x += h)
        for (double y = -radius + 0.5 * h; y < radius; y += h)
            if (x * x + y * y < radius * radius)
                sum += std::exp(-0.5 * ((x - distance) * (x - distance) + y * y)) * h * h;
    return sum / (2.0 * std::numbers::pi);
}

}  // namespace

TEST_CASE("the profile of a blurred disc is the disc under its blur") {
    for (const double radius : {0.5, 1.0, 2.35, 6.0})
        for (const double share : {0.0, 0.5, 1.0, 1.3, 2.0}) {
            CAPTURE(radius, share);
            const double d = share * radius;
            CHECK(std::abs(vessel::blurred_profile(d * d, radius, 1.0).value - by_sum(d, radius)) < 3e-3);
        }
    // Continuous where the table ends.
    CHECK(std::abs(vessel::blurred_profile(144.0, 11.99, 1.0).value -
                   vessel::blurred_profile(144.0, 12.01, 1.0).value) < 0.01);
}

TEST_CASE("the derivatives of both profiles are their slopes") {
    for (const double radius : {0.8, 2.0})
        for (const double d2 : {0.3, 1.0, 4.4}) {
            CAPTURE(radius, d2);
            constexpr double h = 1e-4;
            const auto smooth = vessel::smooth_profile(d2, radius);
            CHECK(smooth.by_squared_distance ==
                  Approx((vessel::smooth_profile(d2 + h, radius).value - vessel::smooth_profile(d2 - h, radius).value) /
                         (2 * h))
                      .margin(1e-5));
            CHECK(smooth.by_radius ==
                  Approx((vessel::smooth_profile(d2, radius + h).value - vessel::smooth_profile(d2, radius - h).value) /
                         (2 * h))
                      .margin(1e-5));
            const auto blurred = vessel::blurred_profile(d2, radius, 0.7);
            constexpr double wide = 0.05;
            CHECK(blurred.by_radius == Approx((vessel::blurred_profile(d2, radius + wide, 0.7).value -
                                               vessel::blurred_profile(d2, radius - wide, 0.7).value) /
                                              (2 * wide))
                                           .margin(0.02));
            CHECK(blurred.by_squared_distance < 0.0);
        }
}

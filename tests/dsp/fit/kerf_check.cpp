// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/kerf_check.hpp"

#include "dsp/fit/fit_energy.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::test;

namespace {

/// An oblique break, rough or smooth, of two halves in place.
struct Oblique {
    Half left, right;
    fit::FitSurface moving, fixed;

    Oblique(double gap, double height, double slope = 0.35, bool is_flat = false)
        : left(half(-1.0, gap, height, slope, is_flat)),
          right(half(1.0, gap, height, slope, is_flat)),
          moving(left.surface()),
          fixed(right.surface()) {}
    static Half half(double side, double gap, double height, double slope, bool is_flat) {
        const Relief rough = rough_relief(3, height);
        return bar_half(side, [rough, slope](double y, double z) { return rough(y, z) + slope * y; },
                        {.gap = gap, .is_flat = is_flat});
    }
    fit::KerfEstimate check(double told, const Pose& pose = {}) const {
        return fit::check_kerf({left.points, &moving}, {right.points, &fixed}, pose, told);
    }
    fit::ContourOpening opening(const Pose& pose) const {
        return fit::contour_opening({left.points, &moving}, {right.points, &fixed}, pose);
    }
};

}  // namespace

TEST_CASE("dsp: the cortex beyond an oblique break says that a told kerf is wrong") {
    const Oblique bar(0.8 * mm, 0.2 * mm);
    const fit::KerfEstimate right = bar.check(0.7 * mm);
    CHECK_FALSE(right.is_doubtful());
    CHECK(right.kerf == Approx(0.7 * mm).margin(0.4 * mm));
    const Vec3 away = glm::normalize(bar.fixed.mean_normal - bar.moving.mean_normal);
    for (const double wrong : {-1.5 * mm, 1.5 * mm}) {
        CAPTURE(wrong);
        const Pose pose{wrong * away, {1.0, 0.0, 0.0, 0.0}};
        CHECK(bar.opening(pose).excess == Approx(wrong).margin(0.4 * mm));
        CHECK(bar.check(0.7 * mm + std::max(0.0, wrong), pose).is_contradicted);
    }
}

TEST_CASE("dsp: a kerf that is wrong by millimetres is found out as well as one that is wrong by one") {
    const Oblique bar(0.5 * mm, 0.02 * mm, 0.8);
    const Vec3 away = glm::normalize(bar.fixed.mean_normal - bar.moving.mean_normal);
    for (const double wrong : {2.0 * mm, 3.5 * mm}) {
        CAPTURE(wrong);
        const Pose pose{wrong * away, {1.0, 0.0, 0.0, 0.0}};
        CHECK(bar.opening(pose).excess == Approx(wrong).epsilon(0.25));
        CHECK(bar.check(0.3 * mm + wrong, pose).is_contradicted);
    }
}

TEST_CASE("dsp: a kerf that is wrong by millimetres is found out on a bone of flat sides, of which only two tell it") {
    const Oblique bar(0.5 * mm, 0.02 * mm, 0.7, true);
    const Vec3 away = fit::opening_direction(bar.moving, bar.fixed, {});
    const double wrong = 4.5 * mm;  // lifts the sides by more than 2 mm
    const Pose pose{wrong * away, {1.0, 0.0, 0.0, 0.0}};
    CHECK(bar.opening(pose).excess == Approx(wrong).epsilon(0.25));
    CHECK(bar.check(0.3 * mm + wrong, pose).is_contradicted);
}

TEST_CASE("dsp: a kerf that nobody told is seen beside an oblique break, and none where none is") {
    const Oblique lost(1.4 * mm, 0.1 * mm), whole(0.0, 0.1 * mm);
    CHECK_FALSE(whole.check(0.0).is_doubtful());
    // Fitted without a kerf, the faces lie on each other.
    const double cosine = glm::length(0.5 * (lost.fixed.mean_normal - lost.moving.mean_normal));
    const Pose closed{-1.4 * mm / cosine * fit::opening_direction(lost.moving, lost.fixed, {}), {1.0, 0.0, 0.0, 0.0}};
    const fit::KerfEstimate seen = lost.check(0.0, closed);
    CHECK(seen.is_contradicted);
    CHECK(seen.kerf == Approx(1.4 * mm).margin(0.4 * mm));
}

TEST_CASE("dsp: a kerf that nobody told is seen beside a break that is nearly square, and none where none is") {
    const Oblique lost(1.4 * mm, 0.02 * mm, 0.025), whole(0.0, 0.02 * mm, 0.025);
    const double cosine = glm::length(0.5 * (lost.fixed.mean_normal - lost.moving.mean_normal));
    const Pose closed{-1.4 * mm / cosine * fit::opening_direction(lost.moving, lost.fixed, {}), {1.0, 0.0, 0.0, 0.0}};
    CAPTURE(lost.opening(closed).excess / mm, lost.opening(closed).spread / mm, whole.opening({}).excess / mm,
            whole.opening({}).spread / mm);
    CHECK(lost.check(0.0, closed).is_contradicted);
    CHECK_FALSE(whole.check(0.0).is_doubtful());
}

TEST_CASE("dsp: a contour that hardly knows the opening does not exclude a kerf, and contradicts no told one") {
    const Oblique square(0.0, 0.1 * mm, 0.004);
    const fit::ContourOpening seen = square.opening({});
    CAPTURE(seen.excess / mm, seen.spread / mm);
    REQUIRE(seen.spread > 1.0 * mm);
    CHECK(square.check(0.0).is_open);
    // A step of 0.02 mm would be an opening of millimetres.
    const Pose aside{Vec3(0.0, 0.02 * mm, 0.0), {1.0, 0.0, 0.0, 0.0}};
    const double told = 0.2 * mm;
    CAPTURE(square.opening(aside).excess / mm);
    REQUIRE(std::abs(square.opening(aside).excess) > 0.5 * mm);
    CHECK_FALSE(square.check(told, aside).is_contradicted);
}

TEST_CASE("dsp: a kerf opens along the plane of the break, wherever the relief leans at its rim") {
    // Over a rectangle, the mean normal knows the relief at the rim only, where this one is highest and lowest.
    const Relief leaning = [](double y, double z) { return 0.35 * y + 1.2 * mm * std::sin(z / (2.546 * mm)); };
    const BarOptions flat{.is_flat = true};
    const Half left = bar_half(-1.0, leaning, flat), right = bar_half(1.0, leaning, flat);
    const fit::FitSurface moving = left.surface(), fixed = right.surface();
    const Vec3 plane = glm::normalize(Vec3(1.0, -0.35, 0.0));
    const Vec3 mean = glm::normalize(fixed.mean_normal - moving.mean_normal),
               opening = fit::opening_direction(moving, fixed, {});
    CHECK(std::abs(glm::dot(opening, plane)) > std::cos(0.04));
    CHECK(std::abs(glm::dot(mean, plane)) < std::cos(0.06));
}

TEST_CASE("dsp: a wide kerf across rough faces is not known to half a millimetre") {
    const Oblique rough(3.0 * mm, 0.6 * mm);
    const double cosine = glm::length(0.5 * (rough.fixed.mean_normal - rough.moving.mean_normal));
    const double limit = 0.5 * mm / (1.0 / cosine - 1.0);
    CHECK(rough.check(1.05 * limit).is_too_wide);
    CHECK_FALSE(rough.check(0.95 * limit).is_too_wide);
    CHECK_FALSE(Oblique(3.0 * mm, 0.02 * mm).check(3.0 * mm).is_too_wide);
    CHECK_FALSE(Oblique(0.8 * mm, 0.6 * mm).check(0.8 * mm).is_too_wide);
}

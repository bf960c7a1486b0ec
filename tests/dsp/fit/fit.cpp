// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"

#include <cstring>
#include <numbers>

using namespace tactus;
using namespace tactus::test;

namespace {

const Half& left() {
    static const Half half = bar_half(-1.0, rough_relief(3));
    return half;
}
const Half& right() {
    static const Half half = bar_half(1.0, rough_relief(3));
    return half;
}

}  // namespace

TEST_CASE("dsp: a broken bar finds together from 8 mm and 20 degrees, and says that it fits") {
    const fit::FitSurface moving = left().surface(), fixed = right().surface();
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const fit::Fit fit = fit::find_fit(moving, fixed, beside(8 * mm, 20 * degree, seed), fit::FitMode::extended);
        INFO("seed " << seed << ", score " << fit.quality.score << ", margin " << fit.margin);
        CHECK(error_of(left(), fit.pose) < 0.1 * mm);
        CHECK(fit.verdict == fit::FitVerdict::fit);
        CHECK(fit.free.empty());
    }
}

TEST_CASE("dsp: the global mode needs no start") {
    const fit::FitSurface moving = left().surface(), fixed = right().surface();
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const fit::Fit fit = fit::find_fit(moving, fixed, beside(200 * mm, 170 * degree, seed), fit::FitMode::global);
        CHECK(error_of(left(), fit.pose) < 0.1 * mm);
        CHECK(fit.verdict == fit::FitVerdict::fit);
    }
}

TEST_CASE("dsp: the thesis' rule closes a small gap") {
    const fit::FitSurface moving = left().surface(), fixed = right().surface();
    const Pose start{{-0.8 * mm, 0.3 * mm, 0.2 * mm}, rotation_by({2 * degree, 0.0, 1 * degree})};
    const fit::Fit fit = fit::find_fit(moving, fixed, start, fit::FitMode::thesis);
    CHECK(error_of(left(), start) > 0.8 * mm);
    CHECK(error_of(left(), fit.pose) < 0.4 * mm);
}

TEST_CASE("dsp: normals that are flipped pull nothing together") {
    Half a = left(), b = right();
    for (Half* half : {&a, &b})
        for (contact::SurfacePoint& p : half->points) p.normal = -p.normal;
    const fit::FitSurface moving = a.surface(), fixed = b.surface();
    const fit::Fit fit = fit::find_fit(moving, fixed, beside(4 * mm, 10 * degree, 1), fit::FitMode::extended);
    CHECK(fit.verdict != fit::FitVerdict::fit);
    CHECK(error_of(left(), fit.pose) > 1 * mm);
}

TEST_CASE("dsp: another bone's fracture does not match, and neither does the mirror image", "[slow]") {
    const fit::FitSurface fixed = right().surface();
    for (std::uint64_t seed = 11; seed <= 13; ++seed) {
        const fit::FitSurface stranger = bar_half(-1.0, rough_relief(seed)).surface();
        CHECK(fit::find_fit(stranger, fixed, {}, fit::FitMode::extended).verdict != fit::FitVerdict::fit);
        CHECK(fit::find_fit(stranger, fixed, {}, fit::FitMode::global).verdict != fit::FitVerdict::fit);
    }
    const fit::FitSurface mirror = mirrored(left()).surface();
    CHECK(fit::find_fit(mirror, fixed, {}, fit::FitMode::extended).verdict != fit::FitVerdict::fit);
    CHECK(fit::find_fit(mirror, fixed, {}, fit::FitMode::global).verdict != fit::FitVerdict::fit);
}

TEST_CASE("dsp: flat faces slide in two directions and turn about their normal") {
    // The paint is a patch amid the cut face of a bar, so that no outer contour is near.
    const Relief flat = [](double, double) { return 0.0; };
    Half a = bar_half(-1.0, flat), b = bar_half(1.0, flat);
    for (Half* half : {&a, &b})
        for (contact::SurfacePoint& p : half->points)
            p.label = std::abs(p.position.x) < 1 * mm && std::hypot(p.position.y, p.position.z) < 4.5 * mm;
    fit::FitSurfaceOptions options;
    options.outline = 0.0;
    const fit::FitSurface moving = fit::make_fit_surface(a.points, a.distance, options);
    const fit::FitSurface fixed = fit::make_fit_surface(b.points, b.distance, options);
    const fit::Fit fit = fit::find_fit(moving, fixed, beside(0.5 * mm, 2 * degree, 1), fit::FitMode::extended);
    CHECK(fit.verdict == fit::FitVerdict::sliding);
    REQUIRE(fit.free.size() == 3);
    int turns = 0;
    for (const fit::FreeDirection& f : fit.free) {
        turns += f.is_rotation;
        CHECK(std::abs(f.axis.x) == Approx(f.is_rotation ? 1.0 : 0.0).margin(0.15));
    }
    CHECK(turns == 1);
}

TEST_CASE("dsp: a round peg in its sleeve may spin and slide along") {
    // The peg's side and the sleeve's bore, both 10 mm in diameter about x.
    const auto cylinder = [](double sign) {
        Half half;
        half.distance.spacing = Vec3(0.5 * mm);
        half.distance.size = {49, 41, 41};
        half.distance.origin = Vec3(-12 * mm, -10 * mm, -10 * mm);
        for (int k = 0; k < 41; ++k)
            for (int j = 0; j < 41; ++j)
                for (int i = 0; i < 49; ++i) {
                    const Vec3 p = half.distance.position(i, j, k);
                    const double round = sign * (std::hypot(p.y, p.z) - 5 * mm);
                    const double wall = sign < 0.0 ? std::hypot(p.y, p.z) - 8 * mm : -1.0;
                    half.distance.values.push_back(static_cast<float>(std::max({round, wall, std::abs(p.x) - 9 * mm})));
                }
        half.points = contact::sample_surface(half.distance, {.spacing = 0.6 * mm});
        for (contact::SurfacePoint& p : half.points)
            if (std::abs(p.position.x) < 5 * mm && std::hypot(p.position.y, p.position.z) < 6 * mm)
                p.label = contact::surface_label::fracture;
        return half;
    };
    fit::FitSurfaceOptions options;
    options.outline = 0.0;
    const Half peg = cylinder(1.0), sleeve = cylinder(-1.0);
    const fit::FitSurface moving = fit::make_fit_surface(peg.points, peg.distance, options);
    const fit::FitSurface fixed = fit::make_fit_surface(sleeve.points, sleeve.distance, options);
    const fit::Fit fit = fit::find_fit(moving, fixed, beside(0.4 * mm, 2 * degree, 2), fit::FitMode::extended);
    CHECK(fit.verdict == fit::FitVerdict::sliding);
    REQUIRE(fit.free.size() == 2);
    CHECK(fit.free[0].is_rotation != fit.free[1].is_rotation);
    for (const fit::FreeDirection& f : fit.free) CHECK(std::abs(f.axis.x) > 0.95);
}

TEST_CASE("dsp: a break that looks the same turned by half is ambiguous") {
    const Relief rough = rough_relief(5);
    const Relief even = [rough](double y, double z) { return 0.7 * (rough(y, z) + rough(-y, -z)); };
    const fit::FitSurface moving = bar_half(-1.0, even).surface(), fixed = bar_half(1.0, even).surface();
    const fit::Fit near = fit::find_fit(moving, fixed, beside(3 * mm, 8 * degree, 1), fit::FitMode::extended);
    CHECK(near.verdict == fit::FitVerdict::ambiguous);
    CHECK(near.margin < 0.05);
    CHECK(fit::find_fit(moving, fixed, {}, fit::FitMode::global).verdict == fit::FitVerdict::ambiguous);
}

TEST_CASE("dsp: chips, spilled and missing paint, lost bone and uneven voxels leave the place as it is", "[slow]") {
    struct Hardship {
        const char* name;
        BarOptions left, right;
        double max_error;
    };
    const std::vector<Hardship> hardships{
        {"a quarter chipped", {.chipped = 0.25}, {}, 0.3 * mm},
        {"half of it chipped", {.chipped = 0.5}, {}, 0.5 * mm},
        {"paint spilled by 2 mm", {.over = 2 * mm}, {.over = 2 * mm}, 0.15 * mm},
        {"half of one side painted", {.half = 0.5}, {}, 0.25 * mm},
        {"uneven voxels", {.voxel = Vec3(0.35, 0.35, 0.7) * mm}, {}, 0.15 * mm},
    };
    for (const Hardship& h : hardships) {
        const Half a = bar_half(-1.0, rough_relief(3), h.left), b = bar_half(1.0, rough_relief(3), h.right);
        const fit::Fit fit =
            fit::find_fit(a.surface(), b.surface(), beside(4 * mm, 10 * degree, 7), fit::FitMode::extended);
        INFO(h.name << ": " << error_of(a, fit.pose) / mm << " mm, " << fit::name_of(fit.verdict));
        CHECK(error_of(a, fit.pose) < h.max_error);
    }
}

TEST_CASE("dsp: an outer contour with a step of its own does not pull the break out of its place") {
    // The left half's lower side is 0.6 to 1.8 mm thicker than the right one's.
    for (const double bend : {1.1, 1.3}) {
        const Half a = bar_half(-1.0, rough_relief(3), {.bend = bend}), b = bar_half(1.0, rough_relief(3));
        const fit::Fit fit =
            fit::find_fit(a.surface(), b.surface(), beside(4 * mm, 10 * degree, 7), fit::FitMode::extended);
        CAPTURE(bend, error_of(a, fit.pose) / mm, fit.quality.outline / mm);
        CHECK(error_of(a, fit.pose) < 0.15 * mm);
        CHECK(fit.verdict == fit::FitVerdict::fit);
    }
}

TEST_CASE("dsp: bone lost along the break is closed, not called a failure", "[slow]") {
    for (const double gap : {0.2 * mm, 0.5 * mm, 1.0 * mm}) {
        const Half a = bar_half(-1.0, rough_relief(3), {.gap = gap}), b = bar_half(1.0, rough_relief(3), {.gap = gap});
        const fit::Fit fit =
            fit::find_fit(a.surface(), b.surface(), beside(4 * mm, 10 * degree, 7), fit::FitMode::extended);
        // Pulled to each other by what was lost.
        CHECK(error_of(a, fit.pose, {{gap, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}) < 0.25 * mm);
        CHECK(fit.verdict == fit::FitVerdict::fit);
    }
}

TEST_CASE("dsp: a start deep inside of the other bone finds out") {
    const fit::FitSurface moving = left().surface(), fixed = right().surface();
    const fit::Fit fit =
        fit::find_fit(moving, fixed, {{7 * mm, 1 * mm, 0.0}, {1.0, 0.0, 0.0, 0.0}}, fit::FitMode::extended);
    CHECK(error_of(left(), fit.pose) < 0.1 * mm);
}

TEST_CASE("dsp: the opposite face of a thin plate does not pull") {
    const fit::FitSurface fixed = right().surface();
    fit::FitSurface moving = left().surface();
    fit::FitEnergy energy(moving, fixed);
    energy.law.gated = false;
    // Half a turn about z brings the left half's break to look the same way as the right half's.
    const Pose facing_away{{0.0, 0.0, 0.0}, rotation_by({0.0, 0.0, std::numbers::pi})};
    energy.look(facing_away);
    const contact::ContactSum sum = energy(facing_away, contact::ContactParts::all);
    energy.look(Pose{});
    const contact::ContactSum fitting = energy(Pose{}, contact::ContactParts::all);
    CHECK(sum.stiffness[0] < 0.05 * fitting.stiffness[0]);
}

TEST_CASE("dsp: far from the origin the fit is the same") {
    const Vec3 far(1.0, -0.7, 0.4);
    const Half a = bar_half(-1.0, rough_relief(3), {.far = far}), b = bar_half(1.0, rough_relief(3), {.far = far});
    const Pose start = beside(4 * mm, 10 * degree, 7);
    const Pose shift{far, {1.0, 0.0, 0.0, 0.0}};
    const fit::Fit fit =
        fit::find_fit(a.surface(), b.surface(), shift * start * shift.inverse(), fit::FitMode::extended);
    CHECK(error_of(a, fit.pose) < 0.1 * mm);
}

TEST_CASE("dsp: the same input gives the same bits") {
    const fit::FitSurface moving = left().surface(), fixed = right().surface();
    const fit::Fit a = fit::find_fit(moving, fixed, beside(6 * mm, 15 * degree, 4), fit::FitMode::extended);
    const fit::Fit b = fit::find_fit(moving, fixed, beside(6 * mm, 15 * degree, 4), fit::FitMode::extended);
    CHECK(std::memcmp(&a.pose, &b.pose, sizeof(Pose)) == 0);
    CHECK(a.iterations == b.iterations);
}

TEST_CASE("dsp: settling takes off what a held pose is away") {
    const fit::FitSurface moving = left().surface(), fixed = right().surface();
    fit::FitEnergy energy(moving, fixed);
    const Pose held = beside(0.15 * mm, 0.4 * degree, 9);
    CHECK(error_of(left(), fit::settle(energy, held, {})) < 0.05 * mm);
    CHECK(error_of(left(), held) > 0.1 * mm);
}

TEST_CASE("dsp: hardly any paint is an error, and so is none") {
    Half few = left();
    int kept = 0;
    for (contact::SurfacePoint& p : few.points)
        if (p.label == contact::surface_label::fracture && ++kept > 20) p.label = contact::surface_label::none;
    CHECK_THROWS_AS(few.surface(), Error);
    for (contact::SurfacePoint& p : few.points) p.label = contact::surface_label::none;
    CHECK_THROWS_AS(few.surface(), Error);
}

TEST_CASE("a few dozen voxels that lie on each other are no fit, however well they do") {
    fit::FitSettings settings;
    fit::widen_for(settings, Vec3(1e-3));
    fit::FitQuality quality;
    quality.score = 0.9;
    quality.share = 0.9;
    quality.overlap = 100e-6;
    CHECK(fit::judge(quality, false, 0.5, settings) == fit::FitVerdict::fit);
    quality.overlap = 25e-6;
    CHECK(fit::judge(quality, false, 0.5, settings) == fit::FitVerdict::no_match);
    fit::FitSettings fine;
    fit::widen_for(fine, Vec3(0.3e-3));
    CHECK(fit::judge(quality, false, 0.5, fine) == fit::FitVerdict::fit);
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/kerf_check.hpp"

#include "dsp/fit/fit_energy.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

using namespace tactus;
using namespace tactus::test;

namespace {

/// An oblique break, rough or smooth, of two halves in place.
struct Oblique {
    Half left, right;
    fit::FitSurface moving, fixed;

    Oblique(double gap, double height, double slope = 0.35, bool is_flat = false)
        : Oblique({.gap = gap, .is_flat = is_flat}, height, slope) {}
    Oblique(const BarOptions& bar, double height, double slope)
        : left(half(-1.0, bar, height, slope)),
          right(half(1.0, bar, height, slope)),
          moving(left.surface()),
          fixed(right.surface()) {}
    static Half half(double side, const BarOptions& bar, double height, double slope) {
        const Relief rough = rough_relief(3, height);
        return bar_half(side, [rough, slope](double y, double z) { return rough(y, z) + slope * y; }, bar);
    }
    fit::KerfEstimate check(std::optional<double> given, const Pose& pose = {}) const {
        return fit::check_kerf({left.points, &moving}, {right.points, &fixed}, pose, given);
    }
    fit::ContourOpening opening(const Pose& pose, std::optional<double> given = std::nullopt) const {
        return fit::contour_opening({left.points, &moving}, {right.points, &fixed}, pose, given);
    }
    /// m: mean width of a gap along the opening.
    double width(double opening) const { return opening * glm::length(0.5 * (fixed.mean_normal - moving.mean_normal)); }
    /// Moved apart along the opening.
    Pose apart(double opening) const {
        return {opening * fit::opening_direction(moving, fixed, {}), {1.0, 0.0, 0.0, 0.0}};
    }
};

}  // namespace

TEST_CASE("dsp: the cortex beyond an oblique break contradicts a wrong given kerf") {
    const Oblique bar(0.8 * mm, 0.2 * mm);
    const double lost = bar.width(0.8 * mm);
    const fit::KerfEstimate right = bar.check(lost);
    CHECK_FALSE(right.is_doubtful());
    CHECK(right.kerf == Approx(0.7 * mm).margin(0.4 * mm));
    for (const double wrong : {-0.8 * mm, 1.5 * mm}) {
        CAPTURE(wrong);
        const double given = std::max(0.01 * mm, lost + bar.width(wrong));
        CHECK(bar.opening(bar.apart(wrong), given).excess == Approx(wrong).margin(0.4 * mm));
        CHECK(bar.check(given, bar.apart(wrong)).is_contradicted);
    }
}

TEST_CASE("dsp: a given kerf that is wrong by millimetres is contradicted like one that is wrong by one") {
    const Oblique bar(0.5 * mm, 0.02 * mm, 0.8);
    for (const double wrong : {2.0 * mm, 3.5 * mm}) {
        CAPTURE(wrong);
        const double given = bar.width(0.5 * mm + wrong);
        CHECK(bar.opening(bar.apart(wrong), given).excess == Approx(wrong).epsilon(0.25));
        CHECK(bar.check(given, bar.apart(wrong)).is_contradicted);
    }
}

TEST_CASE("dsp: a kerf that is wrong by millimetres is contradicted on a bone of flat sides") {
    const Oblique bar(0.5 * mm, 0.02 * mm, 0.7, true);
    const double wrong = 4.5 * mm;  // lifts the sides by more than 2 mm
    const double given = bar.width(0.5 * mm + wrong);
    CHECK(bar.opening(bar.apart(wrong), given).excess == Approx(wrong).epsilon(0.25));
    CHECK(bar.check(given, bar.apart(wrong)).is_contradicted);
}

TEST_CASE("dsp: without a given kerf, the cortex beside an oblique break shows a loss, and none where none is") {
    const Oblique lost(1.4 * mm, 0.1 * mm), whole(0.0, 0.8 * mm);
    CHECK_FALSE(whole.check(std::nullopt).is_doubtful());
    // Fitted without a kerf, the faces lie on each other.
    const Pose closed = lost.apart(-1.4 * mm);
    const fit::KerfEstimate seen = lost.check(std::nullopt, closed);
    CHECK(seen.is_contradicted);
    CHECK(seen.kerf == Approx(lost.width(1.4 * mm)).margin(0.4 * mm));
    // A given kerf of 0 is accepted.
    CHECK_FALSE(lost.check(0.0, closed).is_doubtful());
}

TEST_CASE("dsp: what a contour says of the opening is as uncertain as the faces hold the halves across it") {
    // Both breaks are nearly square: an error across them is one of the opening, forty times as large. Noise of the faces
    // lets the halves be moved along them.
    const auto spread = [](double noise) {
        Oblique bar(0.0, 0.3 * mm, 0.025);
        const Random random{11};
        for (std::size_t n = 0; n < bar.moving.position.size(); ++n)
            bar.moving.position[n] += noise * random.normal(n) * bar.moving.normal[n];
        return bar.opening({}).spread;
    };
    CAPTURE(spread(0.0) / mm, spread(0.15 * mm) / mm);
    CHECK(spread(0.15 * mm) > 1.5 * spread(0.0));
}

TEST_CASE("dsp: what a contour says of the opening of a curved bone is as uncertain as it is wrong") {
    const Random random{21};
    double squares = 0.0, errors = 0.0;
    constexpr std::uint64_t bones = 16;
    for (std::uint64_t n = 0; n < bones; ++n) {
        const BarOptions curved{.swell = (0.5 + random.uniform(4 * n)) * mm,
                                .wave = (18.0 + 18.0 * random.uniform(4 * n + 1)) * mm,
                                .phase = 2.0 * std::numbers::pi * random.uniform(4 * n + 2)};
        const double slope = 0.35 + 0.4 * random.uniform(4 * n + 3);
        const fit::ContourOpening seen = Oblique(curved, 0.2 * mm, slope).opening({});
        CAPTURE(n, seen.excess / mm, seen.spread / mm);
        CHECK(std::abs(seen.excess) < 3.0 * seen.spread);
        squares += seen.excess * seen.excess / (seen.spread * seen.spread);
        errors += seen.excess * seen.excess;
    }
    CAPTURE(std::sqrt(errors / bones) / mm);
    const double ratio = std::sqrt(squares / bones);
    CHECK(ratio > 0.4);
    CHECK(ratio < 1.2);
}

// Costly: 36 bars.
TEST_CASE("dsp: without a kerf, flat faces are no fit, and rough ones that lost nothing are one", "[slow]") {
    constexpr double held = 0.05 * mm;  // by the faces alone
    int rough_fits = 0;
    for (const bool is_flat : {false, true})
        for (const double slope : {0.0, 0.1, 0.35})
            for (const auto& [height, lost] : {std::pair{0.02 * mm, 0.0},
                                               {0.02 * mm, 0.8 * mm},
                                               {0.02 * mm, 1.5 * mm},
                                               {0.3 * mm, 0.0},
                                               {1.0 * mm, 0.0},
                                               {3.0 * mm, 0.0}}) {
                CAPTURE(is_flat, slope, height / mm, lost / mm);
                const Relief rough = rough_relief(3, height);
                const auto relief = [&](double y, double z) { return rough(y, z) + slope * y; };
                // The layer is lost along the normal of the break; the fit closes it.
                const Vec3 shift = lost * glm::normalize(Vec3(1.0, -slope, 0.0));
                const auto closed = [&](double y, double z) { return relief(y + shift.y, z) - shift.x; };
                const Half left = bar_half(-1.0, closed, {.is_flat = is_flat}),
                           right = bar_half(1.0, relief, {.is_flat = is_flat});
                const fit::FitSurface moving = left.surface(), fixed = right.surface();
                const auto judged = [&](std::optional<double> given, fit::PoseBound& bound) {
                    const fit::KerfEstimate seen = fit::check_kerf({left.points, &moving}, {right.points, &fixed},
                                                                   {shift, {1.0, 0.0, 0.0, 0.0}}, given);
                    UNSCOPED_INFO(seen.kerf / mm << " ± " << seen.spread / mm << " mm, loss " << seen.loss / mm);
                    return fit::include_kerf(seen, fit::FitVerdict::fit, bound);
                };
                fit::PoseBound bound{0.0, held, held, false}, none_lost = bound;
                const fit::FitVerdict verdict = judged(std::nullopt, bound);
                if (height < 0.1 * mm) CHECK(verdict != fit::FitVerdict::fit);
                else rough_fits += verdict == fit::FitVerdict::fit && bound.face == held;
                if (verdict != fit::FitVerdict::ambiguous) CHECK(bound.face >= lost);
                CHECK(judged(0.0, none_lost) == fit::FitVerdict::fit);
                CHECK(none_lost.face == held);
            }
    // All of 18 but square breaks: of flat-sided bars, whose contour is uninformative, and of 3 mm of relief, beside which
    // the contour is wrong by a millimetre.
    CHECK(rough_fits >= 14);
}

TEST_CASE("dsp: flat faces that slid along each other until their contours agree may still have lost bone") {
    // Half a millimetre off along the break closes the step that 1.4 mm of lost bone leaves.
    const Oblique bar(1.4 * mm, 0.02 * mm), rough(0.0, 0.8 * mm);
    const Vec3 along(0.35, 1.0, 0.0);
    Pose closed = bar.apart(-1.4 * mm);
    const double step = bar.opening(closed).excess * 0.35;
    closed.position -= step * along;
    const fit::KerfEstimate seen = bar.check(std::nullopt, closed);
    CAPTURE(seen.kerf / mm, seen.spread / mm, step / mm);
    CHECK_FALSE(seen.is_contradicted);
    CHECK(seen.is_flat);
    CHECK(seen.is_open);
    CHECK(seen.loss >= 3.0 * mm);
    CHECK_FALSE(rough.check(std::nullopt).is_flat);
    CHECK(rough.check(std::nullopt).loss == 0.0);
}

TEST_CASE("dsp: the bone that may be lost is in the bound of a fit, which it makes uncertain") {
    const auto included = [](const fit::KerfEstimate& kerf, fit::FitVerdict verdict) {
        fit::PoseBound bound{0.01, 0.3 * mm, 0.4 * mm, false};
        const fit::FitVerdict made = fit::include_kerf(kerf, verdict, bound);
        return std::pair(made, bound);
    };
    fit::KerfEstimate open;
    open.loss = 0.4 * mm;
    open.is_open = true;
    const auto [verdict, bound] = included(open, fit::FitVerdict::fit);
    CHECK(verdict == fit::FitVerdict::uncertain);
    CHECK(bound.face == Approx(0.5 * mm));
    CHECK(bound.far == Approx(0.566 * mm).epsilon(1e-3));
    CHECK(bound.turn == 0.01);
    fit::KerfEstimate refused;
    refused.is_contradicted = true;
    CHECK(included(refused, fit::FitVerdict::fit).first == fit::FitVerdict::ambiguous);
    CHECK(included(refused, fit::FitVerdict::uncertain).first == fit::FitVerdict::uncertain);
    refused.given = 1.0 * mm;
    CHECK(included(refused, fit::FitVerdict::uncertain).first == fit::FitVerdict::ambiguous);
    CHECK(included({}, fit::FitVerdict::fit).first == fit::FitVerdict::fit);
}

TEST_CASE("dsp: a kerf changes neither a verdict without a place nor its bound") {
    fit::KerfEstimate open, refused;
    open.loss = 0.4 * mm;
    open.is_open = true;
    refused.given = 1.0 * mm;
    refused.is_contradicted = true;
    for (const auto verdict :
         {fit::FitVerdict::ambiguous, fit::FitVerdict::sliding, fit::FitVerdict::no_match, fit::FitVerdict::blocked})
        for (const fit::KerfEstimate& kerf : {open, refused}) {
            CAPTURE(fit::name_of(verdict), kerf.is_open);
            fit::PoseBound bound{0.01, 0.3 * mm, 0.4 * mm, false};
            CHECK(fit::include_kerf(kerf, verdict, bound) == verdict);
            CHECK(bound.face == 0.3 * mm);
            CHECK(bound.far == 0.4 * mm);
        }
}

TEST_CASE("dsp: without a given kerf, a nearly square break is no fit, because no loss is excluded") {
    const Oblique square(0.0, 0.1 * mm, 0.004);
    const fit::KerfEstimate seen = square.check(std::nullopt);
    CAPTURE(seen.kerf / mm, seen.spread / mm);
    CHECK(seen.is_open);
    CHECK_FALSE(square.check(0.0).is_doubtful());
}

TEST_CASE("dsp: a contour by which touching faces are too far apart excludes no loss") {
    int surplus = 0;
    for (const double slope : {0.03, 0.06, 0.12}) {
        const Oblique bar(0.0, 0.3 * mm, slope);
        for (const double aside : {-0.12 * mm, -0.08 * mm, -0.04 * mm, 0.04 * mm, 0.08 * mm, 0.12 * mm}) {
            const fit::KerfEstimate seen = bar.check(std::nullopt, {Vec3(0.0, aside, 0.0), {1.0, 0.0, 0.0, 0.0}});
            const double excess = seen.contour.excess, spread = seen.contour.spread;
            CAPTURE(slope, aside / mm, excess / mm, spread / mm);
            if (spread > 1.0 * mm || excess < 1.0 * mm) continue;
            ++surplus;
            CHECK(seen.is_open);
            CHECK(seen.loss >= 2.0 * excess);
        }
    }
    CHECK(surplus > 0);
}

TEST_CASE("dsp: an uninformative contour contradicts a given kerf only by two standard deviations") {
    const Oblique square(0.0, 0.1 * mm, 0.004);
    const fit::ContourOpening seen = square.opening({});
    CAPTURE(seen.excess / mm, seen.spread / mm);
    REQUIRE(seen.spread > 1.0 * mm);
    REQUIRE(std::abs(seen.excess) > 0.5 * mm);
    // An error across the break is an opening of many millimetres: a small one may be the faces', a large one is none.
    const auto is_contradicted_beside = [&](double aside) {
        return square.check(0.05 * mm, {Vec3(0.0, aside, 0.0), {1.0, 0.0, 0.0, 0.0}}).is_contradicted;
    };
    CHECK_FALSE(is_contradicted_beside(0.0));
    CHECK(is_contradicted_beside(0.3 * mm));
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

TEST_CASE("dsp: the pairs of a case say together that nothing is lost where one of them says little") {
    const auto pair = [](double missing, double spread) { return fit::ContourOpening{-missing, spread, 20}; };
    const fit::ContourOpening vague = pair(0.3 * mm, 0.4 * mm), sure = pair(1.1 * mm, 0.1 * mm);
    const std::vector<fit::ContourOpening> whole{pair(0.05 * mm, 0.1 * mm), pair(-0.05 * mm, 0.1 * mm), vague};
    const fit::CommonOpening all = fit::common_opening(whole);
    CHECK(all.pairs == 3);
    // Inverse variances: (100 · 0.05 − 100 · 0.05 + 6.25 · 0.3) / 206.25.
    CHECK(all.missing == Approx(0.00909 * mm).epsilon(1e-3));
    CHECK(all.spread == Approx(0.06963 * mm).epsilon(1e-3));
    CHECK(all.scatter == 0.0);
    CHECK(all.excludes_kerf(vague));
    CHECK_FALSE(fit::common_opening(std::span(whole).first(2)).excludes_kerf(vague));
    CHECK_FALSE(all.excludes_kerf({0.0, 1.0, 0}));

    // One that is surely open says of itself that it is, and of the others that they may be.
    const std::vector<fit::ContourOpening> mixed{whole[0], whole[1], vague, sure};
    const fit::CommonOpening both = fit::common_opening(mixed);
    CHECK(both.scatter > 0.4 * mm);
    CHECK_FALSE(both.excludes_kerf(sure));
    CHECK_FALSE(both.excludes_kerf(vague));
    CHECK(both.excludes_kerf(whole[0]));

    // Many that are whole do not speak for one that says clearly that it is open.
    std::vector<fit::ContourOpening> many(5, pair(0.0, 0.1 * mm));
    many.push_back(pair(0.8 * mm, 0.3 * mm));
    CHECK_FALSE(fit::common_opening(many).excludes_kerf(many.back()));
    many.back() = pair(0.6 * mm, 0.4 * mm);
    CHECK(fit::common_opening(many).excludes_kerf(many.back()));

    // Where all are open, so is the one that says little.
    const std::vector<fit::ContourOpening> lost{sure, sure, sure, vague};
    CHECK_FALSE(fit::common_opening(lost).excludes_kerf(vague));
}

namespace {

/// A cut along a wave. The blade removes `width` across its path, and leaves a different grain on either face.
struct WavyCut {
    double wavelength, amplitude, direction, slope, width;  ///< m, m, rad, m/m, m
    static constexpr double grain = 0.1 * mm;  // rms

    Half half(double side) const {
        const double k = 2.0 * std::numbers::pi / wavelength;
        const double ky = k * std::cos(direction), kz = k * std::sin(direction);
        const Random random{side < 0.0 ? 5u : 6u};
        const auto height = [*this, side, ky, kz, random](double y, double z) {
            // The face lies half a blade from the path, along the path's normal. Iterates to the path's point.
            double at_y = y, at_z = z, rise = 0.0, steep = 1.0;
            for (int pass = 0; pass < 10; ++pass) {
                const double turn = ky * at_y + kz * at_z + 0.7;
                const double dy = slope + amplitude * ky * std::cos(turn), dz = amplitude * kz * std::cos(turn);
                steep = std::sqrt(1.0 + dy * dy + dz * dz);
                rise = slope * at_y + amplitude * std::sin(turn);
                at_y = y + side * 0.5 * width * dy / steep;
                at_z = z + side * 0.5 * width * dz / steep;
            }
            double own = 0.0;
            for (std::uint64_t n = 0; n < 12; ++n) {
                const double q = 2.0 * std::numbers::pi / ((1.0 + 2.0 * random.uniform(3 * n)) * mm),
                             way = 2.0 * std::numbers::pi * random.uniform(3 * n + 1);
                own += std::sin(q * (std::cos(way) * y + std::sin(way) * z) +
                                2.0 * std::numbers::pi * random.uniform(3 * n + 2));
            }
            return rise + side * 0.5 * width / steep + grain * own / std::sqrt(6.0);
        };
        // All samples of a row along the bar have the same y and z.
        double last_y = 1e9, last_z = 1e9, last = 0.0;
        return bar_half(side, [=](double y, double z) mutable {
            if (y == last_y && z == last_z) return last;
            last_y = y, last_z = z;
            return last = height(y, z);
        });
    }
};

/// Checks every `stride`-th cut: closed over the lost bone, it is no fit whose bound is less than the loss.
void check_wavy_cuts(int stride) {
    constexpr double held = 0.15 * mm;  // by the faces alone
    int number = 0;
    for (const double wavelength :
         {4.0 * mm, 6.0 * mm, 8.0 * mm, 12.0 * mm, 16.0 * mm, 20.0 * mm, 36.0 * mm, 60.0 * mm})
        for (const double amplitude : {0.0, 0.2 * mm, 0.5 * mm, 1.0 * mm, 1.5 * mm, 2.0 * mm})
            for (const double slope : {0.1, 0.35}) {
                constexpr double losses[] = {0.3 * mm, 1.0 * mm, 1.5 * mm, 0.6 * mm};
                const WavyCut cut{wavelength, amplitude, 0.5 * (number % 4), slope, losses[number % 4]};
                if (number++ % stride != 0) continue;
                CAPTURE(wavelength / mm, amplitude / mm, cut.direction, slope, cut.width / mm);
                const Half left = cut.half(-1.0), right = cut.half(1.0);
                const fit::FitSurface moving = left.surface(), fixed = right.surface();
                fit::FitEnergy energy(moving, fixed);
                const Vec3 shift = cut.width * glm::normalize(Vec3(1.0, -slope, 0.0));
                const Pose closed = fit::settle(energy, {shift, {1.0, 0.0, 0.0, 0.0}}, fit::FitSettings{});
                const double error = glm::length(closed.apply(moving.centre) - moving.centre);
                CHECK(error > 0.7 * cut.width);
                const fit::KerfEstimate seen =
                    fit::check_kerf({left.points, &moving}, {right.points, &fixed}, closed, std::nullopt);
                fit::PoseBound bound{0.0, held, held, false};
                const fit::FitVerdict verdict = fit::include_kerf(seen, fit::FitVerdict::fit, bound);
                CAPTURE(error / mm, seen.kerf / mm, seen.spread / mm, bound.face / mm);
                CHECK(verdict != fit::FitVerdict::fit);
                CHECK((verdict == fit::FitVerdict::ambiguous || bound.face >= error));
            }
    CHECK(number == 96);
}

}  // namespace

// Costly: eight pairs of halves. 13 has no divisor in common with the four losses.
TEST_CASE("dsp: without a kerf, a wavy saw cut is no fit", "[slow]") { check_wavy_cuts(13); }

// Costly: 96 pairs of halves.
TEST_CASE("dsp: without a kerf, no wavy saw cut of any length and height is a fit", "[long]") { check_wavy_cuts(1); }

// Costly: eight pairs of halves.
TEST_CASE("dsp: without a kerf, faces that share 0.2 mm of relief are a fit", "[slow]") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
        for (const double slope : {0.2, 0.35}) {
            const Relief rough = rough_relief(seed, 0.22 * mm);
            const auto relief = [&](double y, double z) { return rough(y, z) + slope * y; };
            const Half left = bar_half(-1.0, relief), right = bar_half(1.0, relief);
            const fit::FitSurface moving = left.surface(), fixed = right.surface();
            const fit::KerfEstimate seen =
                fit::check_kerf({left.points, &moving}, {right.points, &fixed}, {}, std::nullopt);
            CAPTURE(seed, slope, seen.kerf / mm, seen.spread / mm, seen.loss / mm);
            CHECK_FALSE(seen.is_flat);
            CHECK_FALSE(seen.is_doubtful());
        }
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fit_precision.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/fit/fragment_matcher.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double far_end = 110.0 * mm;

/// Noise of a scan as it is left by smoothing: white noise, averaged with its neighbours.
void add_noise(volume::Grid& grid, double height, std::uint64_t seed) {
    const Random random{seed};
    std::vector<float> white(grid.count()), field(grid.count());
    for (std::size_t n = 0; n < white.size(); ++n) white[n] = static_cast<float>(random.normal(n));
    const std::size_t steps[3] = {1, static_cast<std::size_t>(grid.size[0]),
                                  static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])};
    for (const std::size_t step : steps) {
        for (std::size_t n = step; n + step < white.size(); ++n)
            field[n] = 0.25F * white[n - step] + 0.5F * white[n] + 0.25F * white[n + step];
        white.swap(field);
    }
    double squares = 0.0;
    for (const float v : white) squares += static_cast<double>(v) * static_cast<double>(v);
    const double scale = height / std::sqrt(squares / static_cast<double>(white.size()));
    for (std::size_t n = 0; n < white.size(); ++n) grid.values[n] += static_cast<float>(scale * white[n]);
}

/// One side of a break through a shaft as thick as a fibula, scanned in voxels of 0.6 mm, with paint over the rim. Of the
/// rest of the shaft only its end is there.
Half shaft_half(double side, std::uint64_t seed, double radius, double noise) {
    const Relief relief = rough_relief(seed, 0.45 * mm);
    const auto round = [radius](const Vec3& p) {
        return std::hypot(p.y, p.z) - radius * (1.0 + 0.15 * std::cos(3.0 * std::atan2(p.z, p.y)));
    };
    const auto height = [&](const Vec3& p) { return p.x - relief(p.y, p.z) - 0.4 * p.y; };
    Half made;
    volume::Grid& grid = made.distance;
    grid.spacing = Vec3(0.6 * mm);
    const double wide = 1.15 * radius + 3.0 * mm;
    const Vec3 low(side < 0.0 ? -14.0 * mm : -8.0 * mm, -wide, -wide), high(low.x + 22.0 * mm, wide, wide);
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low[axis]) / (0.6 * mm)) + 1;
    // The voxels of both scans lie differently.
    grid.origin = low + side * Vec3(0.13, 0.21, 0.08) * mm;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const Vec3 p = grid.position(i, j, k);
                grid.values.push_back(
                    static_cast<float>(std::max({round(p), -side * height(p) / 1.2, side * p.x - 11.0 * mm})));
            }
    add_noise(grid, noise, 97 * seed + (side < 0.0 ? 1 : 2));
    made.points = contact::sample_surface(grid, {.spacing = 0.5 * mm});
    for (contact::SurfacePoint& p : made.points)
        if (std::abs(height(p.position)) < 0.7 * mm) p.label = contact::surface_label::fracture;
    contact::SurfacePoint end = made.points.front();
    end.position = {side * far_end, 0.0, 0.0};
    end.label = contact::surface_label::none;
    made.points.push_back(end);
    return made;
}

struct Held {
    fit::FragmentMatch match;
    double far = 0.0, turn = 0.0;  ///< errors: m at the far end, degrees
};

/// What the matcher makes of two halves that lie where they belong.
Held hold(std::uint64_t seed, double radius, double noise) {
    const Half left = shaft_half(-1.0, seed, radius, noise), right = shaft_half(1.0, seed, radius, noise);
    const std::vector<fit::FragmentSurface> surfaces{{left.points, &left.distance}, {right.points, &right.distance}};
    fit::FragmentMatcher matcher(surfaces);
    const std::vector<Pose> poses(2);
    const std::vector<char> stands{1, 1};
    Held held;
    held.match = matcher.near(0, poses, stands);
    const Vec3 end(-far_end, 0.0, 0.0);
    held.far = glm::length(held.match.pose.apply(end) - end);
    held.turn = glm::length(rotation_between({1.0, 0.0, 0.0, 0.0}, held.match.pose.orientation)) / degree;
    return held;
}

}  // namespace

TEST_CASE("dsp: a small noisy face stays at its pose, and is no fit where it cannot hold the far end") {
    double squares = 0.0, said = 0.0;
    int covered = 0;
    constexpr int count = 8;
    for (std::uint64_t seed = 1; seed <= count; ++seed) {
        const Held held = hold(seed, 5.0 * mm, 0.05 * mm);
        INFO(seed << ": " << fit::name_of(held.match.verdict) << ", " << held.far / mm << " mm and " << held.turn
                  << " deg off, said " << held.match.precision.far / mm << " mm");
        const bool is_fit = held.match.verdict == fit::FitVerdict::fit;
        CHECK((!is_fit || held.far < 0.5 * mm));
        CHECK(held.far < 1.2 * mm);
        squares += held.far * held.far;
        said += held.match.precision.far * held.match.precision.far / 4.0;
        covered += held.far <= held.match.bound.far && held.turn * degree <= held.match.bound.turn;
    }
    CHECK(covered >= count - 1);
    // What is said is what it is, within the accuracy of eight samples.
    const double error = std::sqrt(squares / count), deviation = std::sqrt(said / count);
    INFO(error / mm << " mm, said " << deviation / mm);
    CHECK(error < 1.5 * deviation);
    CHECK(deviation < 1.5 * error);
}

TEST_CASE("dsp: a face without noise is a fit, however long the shaft") {
    const Held held = hold(1, 5.0 * mm, 0.001 * mm);
    INFO(fit::name_of(held.match.verdict)
         << ", " << held.far / mm << " mm off, said " << held.match.precision.far / mm << " mm");
    CHECK(held.match.verdict == fit::FitVerdict::fit);
    CHECK(held.far < 0.3 * mm);
}

TEST_CASE("dsp: what is right and not held is uncertain, and what does not belong together is no match") {
    const fit::FitSettings settings;
    fit::FitQuality good;
    good.score = 0.7;
    good.share = 0.6;
    good.overlap = 60e-6;
    good.rms = 0.5 * settings.sigma;
    const auto verdict = [&settings](const fit::FitQuality& quality, double margin, double far) {
        return fit::judge(quality, false, margin, settings, far);
    };
    CHECK(verdict(good, 0.5, 0.5 * mm) == fit::FitVerdict::fit);
    CHECK(verdict(good, 0.5, 4.0 * mm) == fit::FitVerdict::uncertain);
    CHECK(verdict(good, 0.05, 4.0 * mm) == fit::FitVerdict::ambiguous);
    fit::FitQuality chipped = good;
    chipped.rms = 0.8 * settings.sigma;
    CHECK(verdict(chipped, 0.5, 0.5 * mm) == fit::FitVerdict::uncertain);
    CHECK(verdict(chipped, 0.2, 0.5 * mm) == fit::FitVerdict::no_match);
    chipped.score = 0.35;
    CHECK(verdict(chipped, 0.5, 0.5 * mm) == fit::FitVerdict::no_match);
    fit::FitQuality deep = good;
    deep.penetration = 2.0 * mm;
    CHECK(verdict(deep, 0.5, 4.0 * mm) == fit::FitVerdict::blocked);
    for (const auto& [of, answer] : {std::pair(fit::FitVerdict::fit, "fit"),
                                     {fit::FitVerdict::uncertain, "fit, uncertain"},
                                     {fit::FitVerdict::ambiguous, "no match"},
                                     {fit::FitVerdict::no_match, "no match"}})
        CHECK(fit::answer_of(of) == answer);
}

TEST_CASE("dsp: faces must be more alike to fit in voxels of 1 mm than in fine ones") {
    const auto verdict_at = [](double voxel, double score) {
        fit::FitSettings settings;
        fit::widen_for(settings, Vec3(voxel));
        fit::FitQuality quality;
        quality.score = score;
        quality.share = 0.6;
        quality.overlap = 100e-6;
        quality.rms = 0.3 * settings.sigma;
        return fit::judge(quality, false, 0.5, settings);
    };
    for (const double voxel : {0.35 * mm, 0.5 * mm}) CHECK(verdict_at(voxel, 0.4) == fit::FitVerdict::fit);
    fit::FitSettings coarse;
    fit::widen_for(coarse, Vec3(1.0 * mm));
    CHECK(coarse.min_uncertain_score() == Approx(0.5));
    CHECK(coarse.min_fit_score() == Approx(0.6));
    // Strangers reach 0.5 there.
    CHECK(verdict_at(1.0 * mm, 0.4) == fit::FitVerdict::no_match);
    CHECK(verdict_at(1.0 * mm, 0.55) == fit::FitVerdict::uncertain);
    CHECK(verdict_at(1.0 * mm, 0.65) == fit::FitVerdict::fit);
}

TEST_CASE(
    "dsp: the bound of a fit contains a rival that is nearly as good, and two sides of a body never agree better") {
    const fit::FitPrecision precision{0.002, 0.4 * mm, 0.1 * mm};
    const Pose best, slip{Vec3(2.0 * mm, 0.0, 0.0), rotation_by(Vec3(0.0, 0.0, 0.05))};
    const Vec3 face(0.0), far(0.1, 0.0, 0.0);
    const fit::PoseBound alone = fit::bound_of(precision, 0.6, best, slip, face, far, false);
    CHECK_FALSE(alone.has_rival);
    CHECK(alone.far == precision.far);
    const fit::PoseBound with = fit::bound_of(precision, 0.2, best, slip, face, far, false);
    CHECK(with.has_rival);
    CHECK(with.turn == Approx(0.05));
    CHECK(with.face == Approx(2.0 * mm));
    CHECK(with.far == Approx(glm::length(slip.apply(far) - far)));
    const fit::PoseBound healthy = fit::bound_of(precision, 0.6, best, slip, face, far, true);
    CHECK(healthy.far == Approx(1.5 * mm + degree * 100.0 * mm));
    CHECK(healthy.turn == Approx(1.0 * degree));
}

TEST_CASE("dsp: chips widen the bound of a pose by the root of what they add to its scatter") {
    // A flat face with relief slopes in all directions, noise of 10 µm, and chips over a fifth of its area.
    const auto face_with = [](double chipped) {
        const Half left = shaft_half(-1.0, 3, 8.0 * mm, 0.01 * mm), right = shaft_half(1.0, 3, 8.0 * mm, 0.01 * mm);
        fit::FitSurface moving = fit::make_fit_surface(left.points, left.distance);
        const fit::FitSurface fixed = fit::make_fit_surface(right.points, right.distance);
        for (Vec3& p : moving.position)
            if (p.y > (1.0 - 2.0 * chipped) * 8.0 * mm) p.x -= 0.25 * mm;
        fit::FitPrecisionSum sum(Vec3(0.0), Vec3(-far_end, 0.0, 0.0));
        sum.add(moving, fixed, {fixed.centre, {1.0, 0.0, 0.0, 0.0}}, fit::between_centres(moving, fixed, {}));
        return std::pair(sum.precision(), sum.calibrated());
    };
    const auto [whole, whole_bound] = face_with(0.0);
    const auto [chipped, chipped_bound] = face_with(0.2);
    INFO(whole.far / mm << " " << whole_bound.far / mm << " " << chipped.far / mm << " " << chipped_bound.far / mm);
    CHECK(chipped.far > 2.0 * whole.far);
    const double wider = std::sqrt(chipped.far / whole.far);
    CHECK(chipped_bound.far > 0.7 * wider * whole_bound.far);
    CHECK(chipped_bound.far < 1.3 * wider * whole_bound.far);
    // Smoothing shifts surfaces by a share of the voxel.
    constexpr double voxel = 0.6 * mm, bias = 0.12;
    CHECK(chipped_bound.face >= bias * voxel);
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/joint_refinement.hpp"

#include "dsp/contact/voxmap.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/fit/overlap.hpp"
#include "dsp/geometry/dense_cholesky.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"

#include <vector>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("dsp: all faces are fitted together: a chain of three ends where it belongs, and what is fixed stays") {
    // Two lefts on one right: an error of the one in the middle would be an error of both others.
    const Half left = bar_half(-1.0, rough_relief(3)), right = bar_half(1.0, rough_relief(3));
    const std::vector<fit::FragmentSurface> surfaces{
        {left.points, &left.distance}, {right.points, &right.distance}, {left.points, &left.distance}};
    const fit::FragmentMatcher matcher(surfaces);
    std::vector<Pose> poses{{}, beside(0.35 * mm, 0.8 * degree, 1), beside(0.5 * mm, 1.0 * degree, 2)};
    const std::vector<int> body{0, 1, 2};
    const std::vector<char> fixed{1, 0, 0};
    std::vector<fit::FacePair> pairs;
    for (const fit::FacePair& pair : fit::mated_faces(matcher, std::vector<Pose>(3), body))
        if (matcher.fragment_of(pair.first) == 1 || matcher.fragment_of(pair.second) == 1) pairs.push_back(pair);
    REQUIRE(pairs.size() >= 2);
    REQUIRE(fit::refine_jointly(matcher, pairs, body, fixed, poses) > 0);
    CHECK(error_of(right, poses[1]) < 0.05 * mm);
    CHECK(error_of(left, poses[2]) < 0.08 * mm);
    CHECK(error_of(left, poses[0]) == 0.0);
    // Fragments of one body keep their places to each other.
    poses = {{}, beside(0.3 * mm, 0.5 * degree, 5), {}};
    poses[2] = poses[1];
    fit::refine_jointly(matcher, pairs, std::vector<int>{0, 1, 1}, std::vector<char>{1, 0, 1}, poses);
    CHECK(error_of(left, poses[2], poses[1]) < 1e-12);
    CHECK(error_of(right, poses[1]) < 0.05 * mm);
}

TEST_CASE("dsp: two bones lie in each other when more than their surfaces do") {
    const Half left = bar_half(-1.0, rough_relief(3)), right = bar_half(1.0, rough_relief(3));
    const contact::Voxmap a = contact::make_voxmap(left.distance), b = contact::make_voxmap(right.distance);
    const auto overlap = [&](double x) {
        const Pose at{Vec3(x, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}};
        return fit::lie_in_each_other({left.points, &a, {}, {}}, {right.points, &b, at, at}, 0.6 * mm);
    };
    CHECK_FALSE(overlap(0.0));
    CHECK_FALSE(overlap(-0.3 * mm));
    CHECK(overlap(-2.0 * mm));
    CHECK(overlap(-20.0 * mm));
    CHECK_FALSE(overlap(60.0 * mm));
}

TEST_CASE("dsp: a dense positive system is solved, and one that is not positive is refused") {
    std::vector<double> matrix{4.0, 0.0, 0.0, 2.0, 3.0, 0.0, -1.0, 0.5, 5.0}, x{1.0, 2.0, 3.0};
    REQUIRE(geometry::solve_positive(matrix, x));
    CHECK(4.0 * x[0] + 2.0 * x[1] - x[2] == Approx(1.0));
    CHECK(2.0 * x[0] + 3.0 * x[1] + 0.5 * x[2] == Approx(2.0));
    CHECK(-x[0] + 0.5 * x[1] + 5.0 * x[2] == Approx(3.0));
    std::vector<double> singular{1.0, 0.0, 1.0, 1.0}, y{1.0, 1.0};
    CHECK_FALSE(geometry::solve_positive(singular, y));
}

TEST_CASE("dsp: a small patch that fits well by itself is no fit, and neither is a small part of a face") {
    fit::FitQuality q;
    q.score = 0.56;
    q.overlap = 20e-6;
    q.share = 0.05;
    q.rms = 0.05e-3;
    const fit::FitSettings settings;
    // As a real hip had it: score 0.56 and margin 0.35 over 20 mm² of several hundred.
    CHECK(fit::judge(q, false, 0.35, settings) == fit::FitVerdict::no_match);
    q.share = 0.6;
    q.overlap = 12e-6;
    CHECK(fit::judge(q, false, 0.35, settings) == fit::FitVerdict::no_match);
    q.overlap = 60e-6;
    CHECK(fit::judge(q, false, 0.35, settings) == fit::FitVerdict::fit);
    // Distances too large for a fit, small enough for one that chips have spoilt; and those of unrelated faces.
    q.rms = 0.75 * settings.sigma;
    CHECK(fit::judge(q, false, 0.35, settings) == fit::FitVerdict::uncertain);
    q.rms = 0.95 * settings.sigma;
    CHECK(fit::judge(q, false, 0.35, settings) == fit::FitVerdict::no_match);
}

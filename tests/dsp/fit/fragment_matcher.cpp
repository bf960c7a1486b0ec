// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fragment_matcher.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/joint_refinement.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/volume/surface_distance.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"

#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

const Relief& relief() {
    static const Relief made = rough_relief(3);
    return made;
}
const Half& left_half() {
    static const Half made = bar_half(-1.0, relief());
    return made;
}
const Half& right_half() {
    static const Half made = bar_half(1.0, relief());
    return made;
}

fit::FragmentSurface surface_of(const Half& half) { return {half.points, &half.distance}; }

/// The best of all pairs of faces and all ways round.
fit::FragmentMatch searched(fit::FragmentMatcher& matcher, std::span<const Pose> poses, std::span<const char> stands) {
    matcher.begin_search();
    fit::FragmentMatch match;
    do match = matcher.search(0, poses, stands);
    while (matcher.left() > 0);
    return match;
}

}  // namespace

TEST_CASE("dsp: the matcher names a mirrored and a foreign partner, from nearby and from anywhere") {
    const Half mirror = mirrored(right_half()), foreign = bar_half(1.0, rough_relief(12));
    const std::vector<fit::FragmentSurface> surfaces{surface_of(left_half()), surface_of(right_half()),
                                                     surface_of(mirror), surface_of(foreign)};
    fit::FragmentMatcher matcher(surfaces);
    const std::vector<Pose> poses{beside(4 * mm, 10 * degree, 7), {}, {}, {}};
    const auto stands_alone = [&](std::size_t n) {
        std::vector<char> stands(4, 0);
        stands[n] = 1;
        return stands;
    };
    const fit::FragmentMatch own = matcher.near(0, poses, stands_alone(1));
    CHECK(own.verdict == fit::FitVerdict::fit);
    CHECK(own.partner == 1);
    CHECK(error_of(left_half(), own.pose) < 0.1 * mm);
    for (const std::size_t wrong : {2u, 3u}) {
        CAPTURE(wrong);
        CHECK(matcher.near(0, poses, stands_alone(wrong)).verdict != fit::FitVerdict::fit);
        CHECK(searched(matcher, poses, stands_alone(wrong)).verdict != fit::FitVerdict::fit);
    }
    // With all of them to choose from, its own is chosen, from any orientation.
    const std::vector<Pose> far{{Vec3(0.3, 0.1, -0.2), rotation_by({1.0, -2.0, 0.7})}, {}, {}, {}};
    const fit::FragmentMatch found = searched(matcher, far, std::vector<char>(4, 1));
    CHECK(found.verdict == fit::FitVerdict::fit);
    CHECK(found.partner == 1);
    CHECK(error_of(left_half(), found.pose) < 0.1 * mm);
}

TEST_CASE("dsp: what a search found goes along with its partner, and other partners are another search") {
    const Half foreign = bar_half(1.0, rough_relief(12));
    const std::vector<fit::FragmentSurface> surfaces{surface_of(left_half()), surface_of(right_half()),
                                                     surface_of(foreign)};
    fit::FragmentMatcher matcher(surfaces);
    std::vector<Pose> poses{{}, {}, {}};
    std::vector<char> stands{0, 1, 1};
    REQUIRE(searched(matcher, poses, stands).partner == 1);
    matcher.begin_search();
    while (matcher.search(0, poses, stands).verdict != fit::FitVerdict::fit) REQUIRE(matcher.left() > 0);
    REQUIRE(matcher.left() > 0);
    poses[1] = beside(9 * mm, 0.3, 4);
    const fit::FragmentMatch moved = matcher.search(0, poses, stands);
    CHECK(moved.partner == 1);
    CHECK(error_of(left_half(), moved.pose, poses[1]) < 0.1 * mm);
    // The partner is taken away: what was found with it is forgotten.
    stands[1] = 0;
    CHECK(matcher.search(0, poses, stands).partner != 1);
}

TEST_CASE("dsp: a face on either side of a thin plate is pulled to its own side only") {
    // A plate of 1.5 mm with a relief on its upper side, and the block that fits there.
    const auto height = [](double x, double y) { return 0.35 * mm * relief()(x, y) / (0.6 * mm); };
    const auto make = [&](bool plate) {
        Half half;
        half.distance.spacing = Vec3(0.35 * mm);
        half.distance.size = {72, 58, 40};
        half.distance.origin = Vec3(-12.5 * mm, -10 * mm, plate ? -5 * mm : -3 * mm);
        for (int k = 0; k < half.distance.size[2]; ++k)
            for (int j = 0; j < half.distance.size[1]; ++j)
                for (int i = 0; i < half.distance.size[0]; ++i) {
                    const Vec3 p = half.distance.position(i, j, k);
                    const double up = (p.z - height(p.x, p.y)) / 1.1;
                    const double body = plate ? std::max(up, -1.5 * mm - p.z) : std::max(-up, p.z - 6 * mm);
                    half.distance.values.push_back(
                        static_cast<float>(std::max({body, std::abs(p.x) - 9 * mm, std::abs(p.y) - 7 * mm})));
                }
        half.points = contact::sample_surface(half.distance, {.spacing = 0.5 * mm});
        for (contact::SurfacePoint& p : half.points)
            if (std::abs(p.position.z - height(p.position.x, p.position.y)) < 0.2 * mm &&
                std::abs(p.position.x) < 8.6 * mm && std::abs(p.position.y) < 6.6 * mm)
                p.label = contact::surface_label::fracture;
        return half;
    };
    const Half plate = make(true), block = make(false);
    const fit::FitSurface fixed = plate.surface(), moving = block.surface();
    const fit::Fit fit = fit::find_fit(moving, fixed, beside(2 * mm, 6 * degree, 3), fit::FitMode::extended);
    CHECK(fit.verdict == fit::FitVerdict::fit);
    CHECK(error_of(block, fit.pose) < 0.1 * mm);
    // With its face at the plate's lower side nothing holds it there, although that is a millimetre and a half away.
    fit::FitEnergy energy(moving, fixed);
    energy.law.gated = false;
    energy.law.two_sided = false;
    energy.law.scale = 0.5 * mm;
    const auto stiffness_at = [&](const Pose& bodies) {
        const Pose pose = fit::between_centres(moving, fixed, bodies);
        energy.look(pose);
        const contact::ContactSum sum = energy(pose, contact::ContactParts::all);
        return sum.stiffness[14];
    };
    CHECK(stiffness_at({Vec3(0.0, 0.0, -1.5 * mm), {1.0, 0.0, 0.0, 0.0}}) < 0.1 * stiffness_at({}));
}

TEST_CASE("dsp: more faces than there is room for are an error, and hardly any paint fits nothing") {
    const std::vector<fit::FragmentSurface> surfaces{surface_of(left_half()), surface_of(right_half())};
    fit::MatcherSettings one_face;
    one_face.max_faces = 1;
    CHECK_THROWS_AS(fit::FragmentMatcher(surfaces, one_face), Error);
    Half dotted = left_half();
    std::size_t painted = 0;
    for (contact::SurfacePoint& p : dotted.points)
        if (p.label == contact::surface_label::fracture && ++painted > 25) p.label = contact::surface_label::none;
    const std::vector<fit::FragmentSurface> hardly{surface_of(dotted), surface_of(right_half())};
    fit::FragmentMatcher matcher(hardly);
    CHECK(matcher.faces_of(0) == 0);
    const std::vector<Pose> poses(2);
    const std::vector<char> stands{0, 1};
    CHECK(matcher.near(0, poses, stands).verdict == fit::FitVerdict::no_match);
    CHECK(matcher.search(0, poses, stands).verdict == fit::FitVerdict::no_match);
}

TEST_CASE("dsp: a small face is found at either end of a larger one, whichever of the two moves") {
    const Half part = bar_half(1.0, relief(), {.half = 0.45});
    const fit::FragmentMatcher matcher(std::vector<fit::FragmentSurface>{surface_of(left_half()), surface_of(part)});
    REQUIRE(matcher.faces() == 2);
    fit::FitEnergy energy = matcher.make_energy();
    const Pose away{Vec3(0.3, 0.1, -0.2), rotation_by({1.0, -2.0, 0.7})};
    CHECK(error_of(left_half(), matcher.fit_faces(energy, 0, 1, away).pose) < 0.3 * mm);
    CHECK(error_of(part, matcher.fit_faces(energy, 1, 0, away).pose) < 0.3 * mm);
}

TEST_CASE("dsp: coarse scans widen the matcher's scales as they widen a fit's") {
    const Half coarse = bar_half(1.0, relief(), {.voxel = Vec3(1.0 * mm)});
    const fit::FragmentMatcher matcher(std::vector<fit::FragmentSurface>{surface_of(left_half()), surface_of(coarse)});
    const fit::FitSettings alone = fit::settings_for(left_half().surface(), coarse.surface());
    CHECK(matcher.settings.fit.finest == Approx(alone.finest));
    CHECK(matcher.settings.fit.sigma == Approx(alone.sigma));
    CHECK(matcher.settings.fit.polish == Approx(0.5 * alone.polish));
}

TEST_CASE("dsp: chips off one side neither tilt a fit nor close it") {
    // Wedges of up to 1.6 mm off a fifth of the face, all with the same slope.
    const Half chipped = bar_half(-1.0, relief(), {.chipped = 0.2});
    const std::vector<fit::FragmentSurface> surfaces{surface_of(chipped), surface_of(right_half())};
    fit::FragmentMatcher matcher(surfaces);
    for (const std::uint64_t seed : {7u, 8u, 9u}) {
        CAPTURE(seed);
        const std::vector<Pose> poses{beside(3 * mm, 8 * degree, seed), {}};
        const fit::FragmentMatch match = matcher.near(0, poses, std::vector<char>{0, 1});
        REQUIRE(match.verdict == fit::FitVerdict::fit);
        CHECK(glm::length(rotation_between(Quat(1.0, 0.0, 0.0, 0.0), match.pose.orientation)) < 0.025 * degree);
        CHECK(error_of(chipped, match.pose) < 0.015 * mm);
    }
}

TEST_CASE("dsp: a given kerf stays open, from nearby and from anywhere") {
    const Half near_side = bar_half(-1.0, relief(), {.gap = 0.8 * mm});
    const Half far_side = bar_half(1.0, relief(), {.gap = 0.8 * mm});
    const std::vector<fit::FragmentSurface> surfaces{surface_of(near_side), surface_of(far_side)};
    const std::vector<Pose> poses{beside(2 * mm, 6 * degree, 7), {}};
    const std::vector<char> stands{0, 1};
    fit::MatcherSettings settings;
    fit::FragmentMatcher closing(surfaces, settings);
    const fit::FragmentMatch closed = closing.near(0, poses, stands);
    REQUIRE(closed.verdict == fit::FitVerdict::fit);
    CHECK(closed.pose.position.x > 0.5 * mm);
    settings.fit.kerf = 0.7 * mm;  // 0.8 mm along the bar, less across the slopes of the relief
    fit::FragmentMatcher matcher(surfaces, settings);
    const fit::FragmentMatch open = matcher.near(0, poses, stands);
    REQUIRE(open.verdict == fit::FitVerdict::fit);
    CHECK(error_of(near_side, open.pose) < 0.12 * mm);
    CHECK(std::abs(open.quality.gap - 0.7 * mm) < 0.05 * mm);
    CHECK(error_of(near_side, searched(matcher, poses, stands).pose) < 0.12 * mm);
    // And when all faces are fitted together.
    std::vector<Pose> both{beside(0.2 * mm, 0.5 * degree, 3), {}};
    const std::vector<int> body{0, 1};
    const auto pairs = fit::mated_faces(matcher, both, body);
    REQUIRE_FALSE(pairs.empty());
    fit::refine_jointly(matcher, pairs, body, std::vector<char>{0, 1}, both);
    CHECK(error_of(near_side, both[0]) < 0.12 * mm);
}

namespace {

/// The same half with true distances: those of `bar_half` are along the bar, which are none beside a steep relief.
Half measured(Half half) {
    half.distance = volume::signed_distance(
        half.distance, geometry::iso_surface(half.distance, 0.0f, /*inside_above=*/false), run_in_turn);
    return half;
}

/// Mean cosine of the slopes of a break, over the area of its surface.
double mean_cosine(const Relief& relief) {
    double flat = 0.0, area = 0.0;
    for (double y = -5.0 * mm; y < 5.0 * mm; y += 0.1 * mm)
        for (double z = -9.0 * mm; z < 9.0 * mm; z += 0.1 * mm) {
            const double h = 0.01 * mm;
            const double along_y = (relief(y + h, z) - relief(y - h, z)) / (2.0 * h);
            const double along_z = (relief(y, z + h) - relief(y, z - h)) / (2.0 * h);
            flat += 1.0;
            area += std::hypot(1.0, along_y, along_z);
        }
    return flat / area;
}

}  // namespace

TEST_CASE("dsp: rough faces that lost bone all along stay open and straight to the far end of a shaft", "[slow]") {
    for (const std::uint64_t seed : {3u, 8u}) {
        CAPTURE(seed);
        const Relief coarse = rough_relief(seed, 0.8 * mm), fine = rough_relief(seed + 100, 0.3 * mm);
        const Relief rough = [&](double y, double z) { return coarse(y, z) + fine(2.5 * y, 2.5 * z); };
        const BarOptions lost{.voxel = Vec3(0.35 * mm), .gap = 0.8 * mm};
        const Half near_side = measured(bar_half(-1.0, rough, lost)), far_side = measured(bar_half(1.0, rough, lost));
        const std::vector<fit::FragmentSurface> surfaces{surface_of(near_side), surface_of(far_side)};
        fit::MatcherSettings settings;
        settings.fit.kerf = mean_cosine(rough) * 0.8 * mm;  // between the faces; 0.8 mm along the bar
        fit::FragmentMatcher matcher(surfaces, settings);
        const fit::FragmentMatch open =
            matcher.near(0, std::vector<Pose>{beside(2 * mm, 6 * degree, seed), {}}, std::vector<char>{0, 1});
        REQUIRE(open.verdict == fit::FitVerdict::fit);
        CHECK(glm::length(rotation_between(Quat(1.0, 0.0, 0.0, 0.0), open.pose.orientation)) < 0.25 * degree);
        const Vec3 end(-150.0 * mm, 0.0, 0.0);
        CHECK(glm::length(open.pose.apply(end) - end) < 0.5 * mm);
        CHECK(open.quality.gap > 0.5 * mm);
        CHECK(open.quality.gap < 0.8 * mm);
    }
}

TEST_CASE("dsp: the faces of a saw cut stay parallel and as far apart as its blade is thick") {
    const Relief flat = [](double y, double) { return 0.3 * y; };  // cut askew
    const Half near_side = measured(bar_half(-1.0, flat, {.gap = 1.0 * mm}));
    const Half far_side = measured(bar_half(1.0, flat, {.gap = 1.0 * mm}));
    const std::vector<fit::FragmentSurface> surfaces{surface_of(near_side), surface_of(far_side)};
    fit::MatcherSettings settings;
    settings.fit.kerf = 1.0 * mm / std::hypot(1.0, 0.3);
    fit::FragmentMatcher matcher(surfaces, settings);
    const fit::FragmentMatch open =
        matcher.near(0, std::vector<Pose>{beside(2 * mm, 4 * degree, 7), {}}, std::vector<char>{0, 1});
    // It may slide and spin on a flat face, and says so; across the face it is where it was.
    CHECK(open.verdict == fit::FitVerdict::sliding);
    const Vec3 normal = glm::normalize(Vec3(1.0, -0.3, 0.0));
    CHECK(std::abs(glm::dot(open.pose.apply(Vec3(0.0)), normal)) < 0.03 * mm);
    CHECK(glm::length(open.pose.rotate(normal) - normal) < 0.1 * degree);
    CHECK(open.quality.gap == Approx(settings.fit.kerf).margin(0.03 * mm));
}

TEST_CASE("dsp: faces that slide on each other fit with the healthy side in the same fit") {
    // A straight cut: nothing of the faces says where across it the half belongs.
    const Relief flat = [](double, double) { return 0.0; };
    const Half near_side = bar_half(-1.0, flat), far_side = bar_half(1.0, flat);
    const std::vector<fit::FragmentSurface> surfaces{surface_of(near_side), surface_of(far_side)};
    const std::vector<Pose> poses{beside(2 * mm, 4 * degree, 7), {}};
    const std::vector<char> stands{0, 1};
    fit::MatcherSettings settings;
    fit::FragmentMatcher alone(surfaces, settings);
    CHECK(alone.near(0, poses, stands).verdict != fit::FitVerdict::fit);
    // The unbroken bar, 0.2 mm thinner all round, as the other side of a body may be.
    std::vector<contact::SurfacePoint> whole;
    for (const Half* half : {&near_side, &far_side})
        for (contact::SurfacePoint p : half->points) {
            if (p.label == contact::surface_label::fracture || std::abs(p.position.x) > 17.0 * mm) continue;
            p.position -= 0.2 * mm * p.normal;
            whole.push_back(p);
        }
    const fit::RegistrationTarget side(whole);
    settings.healthy.side = &side;
    fit::FragmentMatcher matcher(surfaces, settings);
    const fit::FragmentMatch match = matcher.near(0, poses, stands);
    CHECK(match.verdict == fit::FitVerdict::fit);
    CHECK(error_of(near_side, match.pose) < 0.15 * mm);
    // The faces still decide where they do say something.
    const std::vector<fit::FragmentSurface> rough{surface_of(left_half()), surface_of(right_half())};
    fit::FragmentMatcher both(rough, settings);
    CHECK(error_of(left_half(), both.near(0, poses, stands).pose) < 0.1 * mm);
}

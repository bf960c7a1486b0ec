// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/break_bone.hpp"

#include "assets/plan/paint.hpp"
#include "assets/plan/propose_paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

/// A bar of 10 by 20 mm elliptic section and 40 mm length, bent upwards.
volume::Grid bar() {
    volume::Grid grid{{95, 41, 61}, Vec3(-23.5, -10.0, -15.0) * mm, Vec3(0.5 * mm), {}};
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                Vec3 p = grid.position(i, j, k);
                p.y -= 4.0 * p.x * p.x;
                const double r = std::hypot(p.y / (5.0 * mm), p.z / (10.0 * mm));
                grid.values.push_back(static_cast<float>(std::max((r - 1.0) * 6.0 * mm, std::abs(p.x) - 20.0 * mm)));
            }
    return grid;
}

double volume_of(const volume::Grid& solid) {
    const auto count = std::ranges::count_if(solid.values, [](float d) { return d < 0.0f; });
    return static_cast<double>(count) * solid.spacing.x * solid.spacing.y * solid.spacing.z;
}

double volume_of(const std::vector<volume::Grid>& pieces) {
    double sum = 0.0;
    for (const volume::Grid& piece : pieces) sum += volume_of(piece);
    return sum;
}

}  // namespace

TEST_CASE("assets: the pieces of a broken bone make up the bone, less kerf and chips") {
    const volume::Grid whole = bar();
    for (const int pieces : {2, 4}) {
        const std::vector<volume::Grid> parts = plan::break_bone(whole, {.pieces = pieces, .seed = 3});
        REQUIRE(parts.size() == static_cast<std::size_t>(pieces));
        CHECK(volume_of(parts) == Approx(volume_of(whole)).epsilon(0.01));
        for (const volume::Grid& part : parts) CHECK(volume_of(part) > 0.04 * volume_of(whole));
    }
    const double unhurt = volume_of(plan::break_bone(whole, {.seed = 3}));
    // An ellipse of 157 mm² and more where the break leans.
    const double lost = unhurt - volume_of(plan::break_bone(whole, {.seed = 3, .kerf = 1.0 * mm}));
    CHECK(lost > 140e-9);
    CHECK(lost < 300e-9);
    CHECK(volume_of(plan::break_bone(whole, {.seed = 3, .chips = 0.3})) < unhurt - 5e-9);
}

TEST_CASE("assets: the same seed breaks alike, another seed otherwise") {
    const volume::Grid whole = bar();
    const std::vector<volume::Grid> a = plan::break_bone(whole, {.pieces = 3, .seed = 5}),
                                    b = plan::break_bone(whole, {.pieces = 3, .seed = 5});
    REQUIRE(a.size() == b.size());
    for (std::size_t n = 0; n < a.size(); ++n) CHECK(a[n].values == b[n].values);
    CHECK(plan::break_bone(whole, {.pieces = 3, .seed = 6})[0].values != a[0].values);
}

TEST_CASE("assets: what cannot be broken says so") {
    volume::Grid air = bar();
    for (float& d : air.values) d = 1.0f;
    CHECK_THROWS_AS(plan::break_bone(air, {}), Error);
    CHECK_THROWS_AS(plan::break_bone(bar(), {.pieces = 1}), Error);
    CHECK_THROWS_AS(plan::break_bone(bar(), {.chips = 1.5}), Error);
    CHECK_THROWS_AS(plan::break_bone(bar(), {.kerf = -1.0}), Error);
    CHECK_THROWS_AS(plan::break_bone(bar(), {.pieces = 200}), Error);
}

TEST_CASE("assets: a scan shows a moved solid where it was put, within a fifth of a voxel") {
    const volume::Grid whole = bar();
    const Pose put{Vec3(3.0, -40.0, 7.0) * mm, rotation_by(Vec3(0.3, -0.7, 1.1))};
    const volume::Grid scan = plan::scan_solid(whole, put, {.voxel = Vec3(0.4 * mm), .noise = 0.02, .seed = 4});
    const contact::Voxmap truth = contact::make_voxmap(whole);
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (const contact::SurfacePoint& p : contact::sample_surface(scan, {.spacing = 1.0 * mm})) {
        const Vec3 at = put.inverse().apply(p.position);
        // The flat ends' sharp rims are rounded by any scan.
        if (std::abs(at.x) > 17.0 * mm) continue;
        const volume::Sample here = truth.sample(at);
        const double d = here.value / std::max(glm::length(here.gradient), 0.2);
        sum += d;
        squares += d * d;
        count += 1.0;
    }
    REQUIRE(count > 300.0);
    CHECK(std::abs(sum / count) < 0.08 * mm);
    CHECK(std::sqrt(squares / count) < 0.12 * mm);
}

TEST_CASE("assets: paint covers the break and nothing else, and a proposal finds most of it") {
    const volume::Grid whole = bar();
    const contact::Voxmap map = contact::make_voxmap(whole);
    const std::vector<volume::Grid> parts = plan::break_bone(whole, {.seed = 3});
    const volume::Grid scan = plan::scan_solid(parts[0], {}, {.voxel = Vec3(0.4 * mm)});
    std::vector<contact::SurfacePoint> points = contact::sample_surface(scan, {.spacing = 0.5 * mm});
    plan::paint_fracture(points, map, {});
    double painted = 0.0;
    for (const contact::SurfacePoint& p : points)
        if (p.label == contact::surface_label::fracture) {
            painted += p.area;
            CHECK(map.sample(p.position).value < 0.0);
        }
    CHECK(painted > 130e-6);
    CHECK(painted < 350e-6);
    std::vector<contact::SurfacePoint> guess = points;
    plan::propose_fracture(guess);
    double both = 0.0, proposed = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (guess[i].label != contact::surface_label::fracture) continue;
        proposed += guess[i].area;
        if (points[i].label == contact::surface_label::fracture) both += guess[i].area;
    }
    CHECK(both > 0.7 * painted);
    CHECK(both > 0.6 * proposed);
}

TEST_CASE("assets: what lies inside of the unbroken bone is the break, however smooth and wherever the piece lies",
          "[slow]") {
    const volume::Grid whole = bar();
    const std::vector<contact::SurfacePoint> unbroken = contact::sample_surface(whole, {.spacing = 0.5 * mm});
    const fit::RegistrationTarget intact(unbroken);
    const contact::Voxmap map = contact::make_voxmap(whole);
    const std::vector<volume::Grid> parts = plan::break_bone(whole, {.seed = 3, .roughness = 0.1 * mm});
    const Pose placement{Vec3(30.0, -12.0, 7.0) * mm, rotation_by(Vec3(0.4, -0.2, 0.6))};
    const volume::Grid scan = plan::scan_solid(parts[0], placement, {.voxel = Vec3(0.8 * mm)});
    std::vector<contact::SurfacePoint> points = contact::sample_surface(scan, {.spacing = 0.6 * mm});
    plan::paint_fracture(points, map, placement.inverse());
    std::vector<contact::SurfacePoint> guess = points;
    CHECK(plan::propose_inside(guess, intact, placement.inverse()) > 200);
    double painted = 0.0, both = 0.0, proposed = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool truly = points[i].label == contact::surface_label::fracture,
                   guessed = guess[i].label != contact::surface_label::none;
        painted += truly ? points[i].area : 0.0;
        proposed += guessed ? points[i].area : 0.0;
        both += truly && guessed ? points[i].area : 0.0;
    }
    // All but the rim, which lies as near to the surface of the bone as it was.
    CHECK(both > 0.55 * painted);
    CHECK(both > 0.95 * proposed);
    SECTION("patches far from the other fragment are left out") {
        const std::size_t labelled = plan::propose_inside(guess, intact, placement.inverse());
        std::vector<contact::SurfacePoint> other = guess;
        CHECK(plan::keep_patches_near(guess, other, 1.0 * mm) == labelled);
        for (contact::SurfacePoint& p : other) p.position += Vec3(0.2, 0.0, 0.0);
        CHECK(plan::keep_patches_near(guess, other, 10.0 * mm) == 0);
        CHECK(std::ranges::none_of(
            guess, [](const contact::SurfacePoint& p) { return p.label != contact::surface_label::none; }));
        CHECK_THROWS_AS(plan::keep_patches_near(guess, {}, 1.0), Error);
    }
    SECTION("the unbroken bone itself has nothing inside of it") {
        std::vector<contact::SurfacePoint> all = unbroken;
        CHECK(plan::propose_inside(all, intact, {}) == 0);
    }
}

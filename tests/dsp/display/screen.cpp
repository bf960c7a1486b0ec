// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/screen.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/coupling/placement.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

constexpr double width_px = 1920.0, height_px = 1080.0;

/// A screen of 531 × 299 mm, leaning back.
display::Screen leaning() {
    const Quat lean = coupling::rotation_xyz({-0.6, 0.2, 0.1});
    const Vec3 low_left(-0.25, 0.1, 0.05);
    return {low_left, low_left + lean * Vec3(0.531, 0.0, 0.0), low_left + lean * Vec3(0.0, 0.0, 0.299)};
}

display::Bounds around(const Vec3& middle) {
    display::Bounds box;
    box.add(middle - Vec3(0.15));
    box.add(middle + Vec3(0.15));
    return box;
}

/// Pixels from the lower left, where the line from eye to point passes the screen.
glm::dvec2 analytic(const display::Screen& screen, const Vec3& eye, const Vec3& point) {
    const Vec3 way = point - eye;
    const double t = glm::dot(screen.low_left - eye, screen.normal()) / glm::dot(way, screen.normal());
    const Vec3 at = eye + t * way - screen.low_left;
    const auto share = [&](const Vec3& edge) { return glm::dot(at, edge) / glm::dot(edge, edge); };
    return {share(screen.right()) * width_px, share(screen.up()) * height_px};
}

glm::dvec2 pixel(const display::Projection& projection, const Vec3& point) {
    const auto at = projection.seen(point);
    REQUIRE(at);
    return {0.5 * (at->x + 1.0) * width_px, 0.5 * (at->y + 1.0) * height_px};
}

}  // namespace

TEST_CASE("dsp: through a screen every point is drawn where the eye sees it, both eyes, 200 mm of head travel") {
    const display::Screen screen = leaning();
    const Vec3 middle = screen.low_left + 0.5 * (screen.right() + screen.up());
    const Random random{5};
    std::uint64_t draw = 0;
    const auto within = [&](double reach) {
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = reach * (2.0 * random.uniform(draw++) - 1.0);
        return v;
    };
    double worst = 0.0;
    for (int n = 0; n < 2000; ++n) {
        const Pose head{middle + 0.6 * screen.normal() + within(0.2), coupling::rotation_xyz(within(0.3))};
        const display::Eyes eyes = display::eyes_of(head, 0.063);
        CHECK(glm::length(eyes.right - eyes.left) == Approx(0.063));
        for (const Vec3& eye : {eyes.left, eyes.right}) {
            const display::Projection projection = display::through_screen(screen, eye, around(middle));
            const Vec3 point = middle + within(0.14);
            worst = std::max(worst, glm::length(pixel(projection, point) - analytic(screen, eye, point)));
        }
    }
    CHECK(worst < 1e-6);  // px; half a pixel is asked for
}

TEST_CASE("dsp: a point on the screen stands still when the head moves, and both eyes see it at one place") {
    const display::Screen screen = leaning();
    const Vec3 on_it = screen.low_left + 0.3 * screen.right() + 0.8 * screen.up();
    for (const double travel : {-0.2, 0.0, 0.2}) {
        const display::Eyes eyes =
            display::eyes_of({on_it + 0.6 * screen.normal() + Vec3(travel, 0.0, 0.5 * travel), {1, 0, 0, 0}}, 0.063);
        for (const Vec3& eye : {eyes.left, eyes.right}) {
            const glm::dvec2 at = pixel(display::through_screen(screen, eye, around(on_it)), on_it);
            CHECK(at.x == Approx(0.3 * width_px).margin(1e-6));
            CHECK(at.y == Approx(0.8 * height_px).margin(1e-6));
        }
    }
}

TEST_CASE("dsp: in a mirror the world stands where it is, and triangles turn the other way") {
    // A monitor above, looking down; the mirror half way; the work below it.
    const display::Screen screen{{0.25, 0.0, 0.5}, {-0.25, 0.0, 0.5}, {0.25, 0.3, 0.55}};
    display::Screen square = screen;
    square.high_left = square.low_left + Vec3(0.0, 0.3, 0.05);
    const display::Plane mirror{{0.0, 0.15, 0.2}, glm::normalize(Vec3(0.0, -0.2, 1.0))};
    const Vec3 work(0.02, 0.12, -0.05);
    const Random random{8};
    std::uint64_t draw = 0;
    for (int n = 0; n < 500; ++n) {
        Vec3 off, more;
        for (int axis = 0; axis < 3; ++axis) {
            off[axis] = 0.2 * (2.0 * random.uniform(draw++) - 1.0);
            more[axis] = 0.1 * (2.0 * random.uniform(draw++) - 1.0);
        }
        const Vec3 eye = Vec3(0.0, -0.45, 0.45) + 0.5 * off;
        const display::Projection projection = display::through_mirror(square, mirror, eye, around(work));
        CHECK(projection.is_mirrored);
        CHECK(glm::determinant(Mat3(projection.to_eye)) == Approx(-1.0));
        // What the eye really sees is the image of the screen in the mirror.
        const display::Screen image{mirror.reflected(square.low_left), mirror.reflected(square.low_right),
                                    mirror.reflected(square.high_left)};
        const Vec3 point = work + more;
        CHECK(glm::length(pixel(projection, point) - analytic(image, eye, point)) < 1e-6);
    }
    CHECK(glm::length(mirror.reflected(mirror.reflected(work)) - work) < 1e-15);
    CHECK(glm::length(Vec3(mirror.reflection() * glm::dvec4(work, 1.0)) - mirror.reflected(work)) < 1e-15);
}

TEST_CASE("dsp: an offset between seeing and feeling moves what is seen by just so much") {
    display::DisplayGeometry geometry;
    geometry.screens = {leaning()};
    geometry.haptic_world = {{0.01, 0.02, 0.03}, coupling::rotation_xyz({0.1, 0.2, 0.3})};
    const display::Screen& screen = geometry.screens.front();
    const Pose head{screen.low_left + 0.5 * (screen.right() + screen.up()) + 0.6 * screen.normal(), {1, 0, 0, 0}};
    const Vec3 felt(0.0, 0.05, 0.02);
    const auto co_located = geometry.views(head, true, around(felt));
    REQUIRE(co_located.size() == 2);
    geometry.visuo_haptic_offset = {0.30, 0.0, 0.0};
    const auto apart = geometry.views(head, true, around(felt));
    for (std::size_t eye = 0; eye < 2; ++eye) {
        const Vec3 seen = geometry.haptic_world.apply(felt);
        CHECK(glm::length(pixel(co_located[eye].projection, felt) - analytic(screen, co_located[eye].eye, seen)) <
              1e-6);
        CHECK(glm::length(pixel(apart[eye].projection, felt) -
                          analytic(screen, apart[eye].eye, seen + Vec3(0.30, 0.0, 0.0))) < 1e-6);
    }
}

TEST_CASE("dsp: a display of many directions has one picture for each eye on each screen") {
    display::DisplayGeometry geometry;
    geometry.screens = {leaning(), leaning()};
    std::vector<Vec3> eyes;
    for (int n = 0; n < 8; ++n) eyes.push_back(geometry.screens[0].low_left + Vec3(0.05 * n, -0.6, 0.3));
    const auto views = geometry.views(eyes, around(Vec3(0.0)));
    REQUIRE(views.size() == 16);
    CHECK(views[9].screen == 1);
    CHECK(views[9].eye == eyes[1]);
    CHECK(geometry.views(Pose{eyes[2], {1, 0, 0, 0}}, false, around(Vec3(0.0))).size() == 2);
}

TEST_CASE("dsp: screens without area, skewed ones and eyes behind them are refused") {
    const display::Screen good = leaning();
    const Vec3 middle = good.low_left + 0.5 * (good.right() + good.up());
    CHECK_THROWS_WITH(display::through_screen({good.low_left, good.low_left, good.high_left}, middle, {}),
                      Catch::Matchers::ContainsSubstring("1 mm apart"));
    CHECK_THROWS_WITH(
        display::through_screen({good.low_left, good.low_right, good.high_left + 0.1 * good.right()}, middle, {}),
        Catch::Matchers::ContainsSubstring("square"));
    CHECK_THROWS_WITH(display::through_screen(good, middle - 0.3 * good.normal(), {}),
                      Catch::Matchers::ContainsSubstring("in front"));
    CHECK_THROWS_WITH(display::through_screen(good, Vec3(std::nan("")), {}),
                      Catch::Matchers::ContainsSubstring("in front"));
    CHECK_THROWS_AS(
        (display::DisplayGeometry{{good}, {}, 0.063, {}, {}}.views({Vec3(std::nan("")), {1, 0, 0, 0}}, true, {})),
        Error);
}

TEST_CASE(
    "dsp: a head before a screen, or before its image in a mirror, looks straight at it with its eyes the right way") {
    display::DisplayGeometry geometry;
    geometry.screens = {{{-0.26, 0.15, 0.15}, {0.26, 0.15, 0.15}, {-0.26, -0.15, 0.15}}, leaning()};
    geometry.mirror = display::Plane{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    geometry.screens[1].in_mirror = false;
    for (std::size_t screen = 0; screen < 2; ++screen) {
        const Pose head = geometry.place_before(screen, 0.6);
        CHECK(is_valid(head));
        const Vec3 ahead = head.position - 0.6 * head.rotate({0.0, 0.0, 1.0});
        Vec3 middle = geometry.screens[screen].low_left +
                      0.5 * (geometry.screens[screen].right() + geometry.screens[screen].up());
        if (screen == 0) middle = geometry.mirror->reflected(middle);
        CHECK(glm::length(ahead - middle) < 1e-12);
        // What is nearer than the screen is seen by the left eye farther to the right.
        const Vec3 near = head.position - 0.4 * head.rotate({0.0, 0.0, 1.0});
        const display::Eyes eyes = display::eyes_of(head, 0.064);
        const auto left = geometry.view(screen, eyes.left, around(near)).projection.seen(near);
        const auto right = geometry.view(screen, eyes.right, around(near)).projection.seen(near);
        REQUIRE((left && right));
        CHECK(left->x - right->x > 0.05);
    }
    // The image of a flat monitor lies beneath the mirror; who sits at its near side has y ahead.
    CHECK(geometry.place_before(0, 0.6).rotate({1.0, 0.0, 0.0}).x == Approx(1.0));
    CHECK(geometry.is_mirrored(0));
    CHECK_FALSE(geometry.is_mirrored(1));
}

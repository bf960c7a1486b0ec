// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/camera.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;

namespace {

display::Bounds box() {
    display::Bounds box;
    box.add({-0.05, -0.02, 0.10});
    box.add({0.07, 0.04, 0.13});
    return box;
}

}  // namespace

TEST_CASE("dsp: from the front the patient's left is on the right, and up is up") {
    display::OrbitCamera camera;
    camera.fit(box(), 1.5);
    camera.look_from(display::NamedView::front);
    const display::Projection front = camera.projection(1.5, box());
    CHECK(front.seen(camera.target + Vec3(0.01, 0.0, 0.0))->x > 0.0);
    CHECK(front.seen(camera.target + Vec3(0.0, 0.0, 0.01))->y > 0.0);
    camera.look_from(display::NamedView::back);
    CHECK(camera.projection(1.5, box()).seen(camera.target + Vec3(0.01, 0.0, 0.0))->x < 0.0);
    // From above the front of the patient is at the top of the picture.
    camera.look_from(display::NamedView::top);
    CHECK(camera.projection(1.5, box()).seen(camera.target + Vec3(0.0, -0.01, 0.0))->y > 0.0);
    for (int number = 1; number <= 7; ++number) {
        camera.look_from(*display::view_of_number(number));
        CHECK(glm::length(camera.orientation) == Approx(1.0));
        CHECK(display::view_of_name(display::view_names[static_cast<std::size_t>(number - 1)]) ==
              display::view_of_number(number));
    }
    CHECK_FALSE(display::view_of_number(8));
    CHECK_FALSE(display::view_of_name("behind"));
}

TEST_CASE("dsp: a tool is looked at from its own side") {
    display::OrbitCamera camera;
    for (const double x : {-0.1, 0.1})
        for (const double y : {-0.1, 0.1}) {
            camera.look_from_side_of(box().middle() + Vec3(x, y, 0.0), box());
            const Vec3 towards_eye = camera.eye() - camera.target;
            CHECK(towards_eye.x * x > 0.0);
            CHECK(towards_eye.y * y > 0.0);
            CHECK(towards_eye.z > 0.0);
        }
}

TEST_CASE("dsp: after a fit all corners are in the picture, and one touches its margin") {
    for (const double aspect : {0.5, 1.0, 1.8})
        for (int number = 1; number <= 7; ++number) {
            display::OrbitCamera camera;
            camera.look_from(*display::view_of_number(number));
            camera.fit(box(), aspect);
            double widest = 0.0;
            for (const Vec3& corner : box().corners()) {
                const auto at = camera.projection(aspect, box()).seen(corner);
                REQUIRE(at);
                widest = std::max({widest, std::abs(at->x), std::abs(at->y)});
            }
            CHECK(widest == Approx(1.0 / 1.06));
        }
}

TEST_CASE("dsp: orbiting keeps the distance, stops at the poles and comes round again") {
    display::OrbitCamera camera;
    camera.fit(box(), 1.0);
    const Vec3 eye = camera.eye();
    for (int i = 0; i < 36; ++i) camera.orbit(2.0 * M_PI / 36.0, 0.0);
    CHECK(glm::length(camera.eye() - eye) < 1e-9);
    for (int i = 0; i < 100; ++i) camera.orbit(0.01, 0.3);
    CHECK(glm::length(camera.eye() - camera.target) == Approx(camera.distance));
    const Vec3 up = camera.orientation * Vec3(0.0, 1.0, 0.0);
    CHECK(up.z > 0.0);  // never upside down
    CHECK(glm::normalize(camera.eye() - camera.target).z == Approx(1.0).margin(1e-4));
}

TEST_CASE("dsp: panning moves what is seen by its share of the picture, zooming brings it nearer") {
    display::OrbitCamera camera;
    camera.fit(box(), 1.0);
    const Vec3 mark = camera.target;
    camera.pan(0.25, -0.1);
    const auto at = camera.projection(1.0, box()).seen(mark);
    REQUIRE(at);
    CHECK(at->x == Approx(0.5));
    CHECK(at->y == Approx(-0.2));
    const double before = camera.distance;
    camera.zoom(2.0);
    CHECK(camera.distance == Approx(0.5 * before));
    camera.zoom(0.0);
    CHECK(camera.distance == Approx(0.5 * before));
}

TEST_CASE("dsp: all of a scene lies within the depth of its picture") {
    display::OrbitCamera camera;
    camera.fit(box(), 1.0);
    const display::Projection projection = camera.projection(1.0, box());
    for (const Vec3& corner : box().corners()) {
        const glm::dvec4 clip = projection.to_clip * (projection.to_eye * glm::dvec4(corner, 1.0));
        CHECK(std::abs(clip.z / clip.w) < 1.0);
    }
    const display::DepthRange nothing = display::depth_range(display::Mat4(1.0), {});
    CHECK(nothing.near > 0.0);
    CHECK(nothing.far > nothing.near);
}

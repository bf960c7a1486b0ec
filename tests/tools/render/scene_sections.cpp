// SPDX-License-Identifier: Apache-2.0
// Sections of bones and the density that they show.
#include "tools/render/scene_model.hpp"

#include "devices/display/picture_maker.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/held_lane.hpp"
#include "tests/tools/render/one_ball.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::render;
using namespace tactus::test;

TEST_CASE("a section shows in grey the density of the place that is cut, whatever the view and the plane") {
    if (!can_render()) return;
    // Density rises along x: what a pixel shows tells which x it shows.
    volume::Grid density = ball(0.01);
    for (int k = 0; k < 49; ++k)
        for (int j = 0; j < 49; ++j)
            for (int i = 0; i < 49; ++i)
                density.at(i, j, k) = static_cast<float>(1000.0 + density.position(i, j, k).x * 1e5);
    volume::BoneEditor editor(ball(0.01), density, {.band = 0.002});
    observe::Observer observer;
    const volume::BoneSnapshot initial = editor.current();
    const auto port =
        observer.open({"carve.bone", at_60_hz, 1}, value::snapshot<volume::BoneSnapshot>, bytes_of(initial));
    constexpr int size = 200;
    display::PictureMaker maker(size, size);
    SceneOutline outline;
    outline.bones = {{"carve.bone"}};
    SceneModel model(outline, observer, maker.renderer());
    observer.advance();
    model.update();
    display::OrbitCamera camera;
    camera.fit(model.bounds(), 1.0);
    const display::Plane planes[] = {{Vec3(0.0, -0.001, 0.0), Vec3(0.0, -1.0, 0.0)},
                                     {Vec3(0.001, 0.0, 0.002), glm::normalize(Vec3(0.4, -1.0, 0.5))}};
    for (const auto& plane : planes)
        for (const bool is_quick : {false, true})
            for (const bool shows : {true, false}) {
                INFO(plane.normal.x << " quick " << is_quick << " shows " << shows);
                camera.look_from(display::NamedView::iso);
                camera.fit(model.bounds(), 1.0);
                model.show_density(shows);
                display::Picture& picture = model.update();
                picture.clip = plane;
                picture.is_quick = is_quick;
                const auto views = display::views_of(camera, picture.bounds, size, size, display::StereoMode::mono);
                const display::Image image = maker.draw(picture, views);
                CHECK(model.legend().scales.size() == (shows ? 2 : 1));
                // Rays through pixels, met with the plane by themselves.
                const display::Mat4 back = glm::inverse(views[0].projection.to_clip * views[0].projection.to_eye);
                const Vec3 eye = camera.eye();
                int inside = 0;
                for (int y = 10; y < size; y += 9)
                    for (int x = 10; x < size; x += 9) {
                        const glm::dvec4 far =
                            back * glm::dvec4(2.0 * (x + 0.5) / size - 1.0, 1.0 - 2.0 * (y + 0.5) / size, 1.0, 1.0);
                        const Vec3 way = Vec3(far) / far.w - eye;
                        const double share = glm::dot(plane.point - eye, plane.normal) / glm::dot(way, plane.normal);
                        const Vec3 at = eye + share * way;
                        if (!(share > 0.0) || glm::length(at) > 0.0092) continue;
                        ++inside;
                        const std::uint8_t* const pixel = image.pixel(x, y);
                        CAPTURE(x, y, at.x, at.y, at.z);
                        if (!shows) {
                            CHECK(pixel[0] > pixel[2] + 30);  // the flat colour of a section
                            continue;
                        }
                        const double wanted = 255.0 * (1000.0 + at.x * 1e5) / 2000.0;
                        CHECK(pixel[0] == Approx(wanted).margin(3.0));
                        CHECK(pixel[1] == pixel[0]);
                        CHECK(pixel[2] == pixel[0]);
                    }
                CHECK(inside > 60);
                picture.clip.reset();
                picture.is_quick = false;
            }
}

TEST_CASE("the density of bones comes into the sections of a window beside its pictures") {
    if (!can_render()) return;
    volume::Grid density = ball(0.01);
    std::ranges::fill(density.values, 1800.0f);
    volume::BoneEditor editor(ball(0.01), density, {.band = 0.002});
    observe::Observer observer;
    const volume::BoneSnapshot initial = editor.current();
    const auto a = observer.open({"a.bone", at_60_hz, 1}, value::snapshot<volume::BoneSnapshot>, bytes_of(initial));
    const auto b = observer.open({"b.bone", at_60_hz, 1}, value::snapshot<volume::BoneSnapshot>, bytes_of(initial));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.bones = {{"a.bone"}, {"b.bone"}};
    SceneModel model(outline, observer, maker.renderer());
    model.spread_work();
    observer.advance();
    const auto wait = [&](const auto& is_there) {
        for (int n = 0; n < 5000 && !is_there(); ++n) {
            model.update();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return is_there();
    };
    REQUIRE(wait([&] { return model.is_fitted(); }));
    const auto scans = [&] {
        return std::ranges::count_if(model.update().meshes, [](const auto& drawn) { return drawn.scan >= 0; });
    };
    model.show_density(true);
    {
        const test::HeldLane held(analysis::Lane::scene);
        REQUIRE(wait([&] { return analysis::jobs_waiting(analysis::Lane::scene) == 2; }));
        CHECK(scans() == 0);
        CHECK(model.is_reading_density());
    }
    REQUIRE(wait([&] { return !model.is_reading_density(); }));
    CHECK(scans() == 2);
}

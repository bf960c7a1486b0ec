// SPDX-License-Identifier: Apache-2.0
#include "devices/display/scene_renderer.hpp"
#include "devices/display/legend.hpp"
#include "devices/display/picture_maker.hpp"
#include "devices/display/shapes.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace tactus;
using tactus::test::can_render;

namespace {

geometry::SurfacePatch ball(double radius, const Vec3& colour) {
    geometry::SurfacePatch patch;
    display::add_ball(patch, Vec3(0.0), radius, colour);
    return patch;
}

display::Bounds cube(double half) {
    display::Bounds bounds;
    bounds.add(Vec3(-half));
    bounds.add(Vec3(half));
    return bounds;
}

bool is_red(const std::uint8_t* p) { return p[0] > 100 && p[0] > 2 * p[1] && p[0] > 2 * p[2]; }
bool is_blue(const std::uint8_t* p) { return p[2] > 100 && p[2] > 2 * p[0]; }

/// A red ball on the patient's right (−x), a blue one on the left, from the front.
struct TwoBalls {
    display::PictureMaker maker{240, 160};
    display::Picture picture;
    display::OrbitCamera camera;

    TwoBalls() {
        display::MeshPool& meshes = maker.renderer().meshes();
        const display::MeshPool::Mesh red = meshes.make(), blue = meshes.make();
        meshes.set_part(red, 0, ball(0.01, {0.9, 0.1, 0.1}));
        meshes.set_part(blue, 0, ball(0.01, {0.1, 0.1, 0.9}));
        picture.meshes = {{red, {{-0.02, 0.0, 0.0}, {1, 0, 0, 0}}, 1.0, true},
                          {blue, {{0.02, 0.0, 0.0}, {1, 0, 0, 0}}, 1.0, true}};
        picture.bounds = cube(0.035);
        camera.look_from(display::NamedView::front);
        camera.fit(picture.bounds, 1.5);
    }
    std::vector<display::DrawnView> views(display::StereoMode mode = display::StereoMode::mono) const {
        return display::views_of(camera, picture.bounds, 240, 160, mode);
    }
    display::Image draw(display::StereoMode mode = display::StereoMode::mono) {
        return maker.draw(picture, views(mode));
    }
};

int count(const display::Image& image, bool (*what)(const std::uint8_t*)) {
    int n = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) n += what(image.pixel(x, y));
    return n;
}

}  // namespace

TEST_CASE("a scene is drawn as the camera sees it, and the same again") {
    if (!can_render()) return;
    TwoBalls scene;
    const display::Image image = scene.draw();
    int red_left = 0, blue_right = 0;
    for (int x = 0; x < 120; ++x) red_left += is_red(image.pixel(x, 80));
    for (int x = 120; x < 240; ++x) blue_right += is_blue(image.pixel(x, 80));
    CHECK(red_left > 15);
    CHECK(blue_right > 15);
    CHECK(scene.draw().rgb == image.rgb);
    scene.camera.look_from(display::NamedView::back);
    CHECK(is_blue(scene.draw().pixel(240 - 1 - 160, 80)) != is_blue(image.pixel(240 - 1 - 160, 80)));
}

TEST_CASE("parts of a mesh are replaced and taken away one by one, however often") {
    if (!can_render()) return;
    TwoBalls scene;
    display::MeshPool& meshes = scene.maker.renderer().meshes();
    const display::MeshPool::Mesh mesh = meshes.make();
    const display::Image before = scene.draw();
    geometry::SurfacePatch patch = ball(0.005, {0.1, 0.8, 0.1});
    for (std::uint32_t part = 0; part < 200; ++part) meshes.set_part(mesh, part, patch);
    CHECK(meshes.triangles(mesh) == 200 * patch.triangles.size() / 3);
    for (int again = 0; again < 20; ++again)
        for (std::uint32_t part = 0; part < 200; ++part)
            meshes.set_part(mesh, part, again % 2 ? patch : geometry::SurfacePatch{});
    CHECK(meshes.triangles(mesh) == 200 * patch.triangles.size() / 3);
    CHECK(scene.draw().rgb == before.rgb);  // what others have is untouched
    meshes.remove(mesh);
    CHECK(meshes.triangles(meshes.make()) == 0);
    patch.triangles.back() = static_cast<std::uint32_t>(patch.vertices.size());
    CHECK_THROWS_WITH(meshes.set_part(mesh, 0, patch), Catch::Matchers::ContainsSubstring("vertex"));
}

TEST_CASE("a pose that is not a number is not drawn, and nothing else suffers") {
    if (!can_render()) return;
    TwoBalls scene;
    const display::Image both = scene.draw();
    scene.picture.meshes[0].pose.position.x = std::numeric_limits<double>::quiet_NaN();
    const display::Image one = scene.draw();
    CHECK(count(both, is_red) > 300);
    CHECK(count(one, is_red) == 0);
    CHECK(count(one, is_blue) == count(both, is_blue));
}

TEST_CASE("what is above a clip plane is taken away, and the cut shows the colour of a section") {
    if (!can_render()) return;
    TwoBalls scene;
    scene.picture.clip = display::Plane{{0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}};  // the front half goes
    scene.picture.section = {0.0, 1.0, 0.0};
    const display::Image image = scene.draw();
    const auto is_section = [](const std::uint8_t* p) { return p[1] > 200 && p[0] < 60 && p[2] < 60; };
    CHECK(count(image, is_section) > 600);
    CHECK(count(image, is_red) == 0);  // looking straight in, only sections are left
    scene.picture.clip = display::Plane{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
    const display::Image half = scene.draw();
    CHECK(count(half, is_red) > 300);
    CHECK(count(half, is_blue) == 0);
}

TEST_CASE("a point of a surface is picked where it is, and the background is nothing") {
    if (!can_render()) return;
    TwoBalls scene;
    const auto views = scene.views();
    const auto at = views.front().projection.seen(Vec3(0.02, -0.01, 0.0));  // the nearest point of the blue ball
    REQUIRE(at);
    const double x = 120.0 * (at->x + 1.0), y = 80.0 * (at->y + 1.0);
    const auto picked = scene.maker.renderer().pick(scene.picture, views.front(), x, y);
    REQUIRE(picked);
    CHECK(picked->mesh == 1);
    CHECK(glm::length(picked->position - Vec3(0.02, -0.01, 0.0)) < 2e-4);
    CHECK_FALSE(scene.maker.renderer().pick(scene.picture, views.front(), 2.0, 2.0));
    CHECK_FALSE(scene.maker.renderer().pick(scene.picture, views.front(), -5.0, 2.0));
    // Picking leaves the picture alone.
    const display::Image before = scene.draw();
    scene.maker.renderer().pick(scene.picture, views.front(), x, y);
    CHECK(scene.draw().rgb == before.rgb);
}

TEST_CASE("two eyes see side by side, or in red and cyan, with no parallax at the target") {
    if (!can_render()) return;
    TwoBalls scene;
    const display::Image pair = scene.draw(display::StereoMode::side_by_side);
    int left = 0, right = 0;
    for (int y = 0; y < 160; ++y)
        for (int x = 0; x < 240; ++x) (x < 120 ? left : right) += is_red(pair.pixel(x, y));
    CHECK(left > 100);
    CHECK(std::abs(left - right) < left / 4);
    // Grey at the target, so that both eyes' channels agree: nothing is coloured.
    display::MeshPool& meshes = scene.maker.renderer().meshes();
    const display::MeshPool::Mesh grey = meshes.make();
    geometry::SurfacePatch square;
    display::add_square(square, Vec3(0.0), {0.0, -1.0, 0.0}, 0.03, {0.5, 0.5, 0.5}, 1.0);
    meshes.set_part(grey, 0, square);
    scene.picture.meshes = {{grey, {}, 1.0, true}};
    const auto coloured = [](const std::uint8_t* p) { return std::abs(p[0] - p[2]) > 24; };
    CHECK(count(scene.draw(display::StereoMode::anaglyph), coloured) == 0);
    scene.picture.meshes[0].pose.position.y = 0.03;  // behind the target the eyes differ
    CHECK(count(scene.draw(display::StereoMode::anaglyph), coloured) > 30);
}

TEST_CASE("in a mirror the picture is turned about and bodies still look solid") {
    if (!can_render()) return;
    TwoBalls scene;
    display::DrawnView plain = scene.views().front();
    const display::Image straight = scene.draw();
    display::DrawnView turned = plain;
    turned.projection.to_eye = glm::dmat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1) * plain.projection.to_eye;
    turned.projection.is_mirrored = true;
    const display::Image mirrored = scene.maker.draw(scene.picture, {&turned, 1});
    CHECK(count(mirrored, is_red) == Approx(count(straight, is_red)).epsilon(0.1));
    CHECK(is_red(straight.pixel(70, 80)));
    CHECK(is_red(mirrored.pixel(239 - 70, 80)));
    scene.picture.clip = display::Plane{{0.0, 0.0, 0.0}, {0.0, -1.0, 0.0}};
    scene.picture.section = {0.0, 1.0, 0.0};
    const auto is_section = [](const std::uint8_t* p) { return p[1] > 200 && p[0] < 60 && p[2] < 60; };
    CHECK(count(scene.maker.draw(scene.picture, {&turned, 1}), is_section) > 600);
}

TEST_CASE("a million triangles are drawn", "[slow]") {
    if (!can_render()) return;
    display::PictureMaker maker(160, 120);
    display::MeshPool& meshes = maker.renderer().meshes();
    const display::MeshPool::Mesh mesh = meshes.make();
    display::Picture picture;
    picture.meshes = {{mesh, {}, 1.0, true}};
    geometry::SurfacePatch patch;
    for (std::uint32_t part = 0; part < 64; ++part) {
        patch = {};
        for (int n = 0; n < 16; ++n)
            display::add_ball(patch, {0.01 * (part % 8), 0.002 * n, 0.01 * (part / 8)}, 0.004, {0.9, 0.1, 0.1});
        meshes.set_part(mesh, part, patch);
    }
    CHECK(meshes.triangles(mesh) > 1'000'000);
    picture.bounds.add(Vec3(-0.01));
    picture.bounds.add(Vec3(0.08, 0.04, 0.08));
    display::OrbitCamera camera;
    camera.fit(picture.bounds, 4.0 / 3.0);
    CHECK(count(maker.draw(picture, display::views_of(camera, picture.bounds, 160, 120, display::StereoMode::mono)),
                is_red) > 3000);
}

TEST_CASE("an empty scene is background, and an empty bone has no triangles") {
    if (!can_render()) return;
    display::PictureMaker maker(64, 48);
    display::Picture picture;
    const display::MeshPool::Mesh mesh = maker.renderer().meshes().make();
    maker.renderer().meshes().set_part(mesh, 0, {});
    picture.meshes = {{mesh, {}, 1.0, true}};
    const display::OrbitCamera camera;
    const display::Image image = maker.draw(picture, display::views_of(camera, {}, 64, 48, display::StereoMode::mono));
    CHECK(image.pixel(32, 2)[0] > image.pixel(32, 45)[0]);  // bright sky above
    CHECK(count(image, is_red) == 0);
}

TEST_CASE("a legend lies in its corner, its scale runs from one colour to the other") {
    display::Legend legend;
    legend.title = "Saw training";
    legend.scales.push_back(display::density_scale({}));
    legend.entries.push_back({"blade", {0.2, 0.3, 0.9}});
    const display::Image box = display::legend_image(legend, 1.0);
    CHECK(box.width > 100);
    CHECK(count(box, is_blue) > 60);
    display::Image image{800, 600, std::vector<std::uint8_t>(800 * 600 * 3, 0)};
    display::add_legend(image, legend);
    display::add_scale_bar(image, 1e-4);
    CHECK(image.pixel(20, 580)[0] > 100);
    CHECK(image.pixel(780, 580)[0] > 100);
    CHECK(image.pixel(400, 100)[0] == 0);
    display::add_legend(image, {});
}

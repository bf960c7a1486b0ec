// SPDX-License-Identifier: Apache-2.0
// A slow picture of a scene, drawn in steps.
#include "devices/display/picture_maker.hpp"
#include "devices/display/shapes.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"
#include "tools/window/scene/scene_screens.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <cstdint>
#include <vector>

using namespace tactus;
using namespace tactus::window;
using render::SightChoice;
using tactus::test::can_render;

namespace {

std::vector<std::uint8_t> pixels(const SceneScreens::Tile& tile) {
    std::vector<std::uint8_t> all(static_cast<std::size_t>(4 * tile.picture_width * tile.picture_height));
    glBindTexture(GL_TEXTURE_2D, tile.texture);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, all.data());
    return all;
}

/// Balls that hide each other, of several parts, opaque and transparent, a clip plane, dots, and an arrow that shines
/// through.
display::Picture picture_with(display::MeshPool& meshes) {
    display::Picture picture;
    const auto ball = [&](const Vec3& at, double opacity, const Vec3& colour) {
        const display::MeshPool::Mesh mesh = meshes.make();
        for (std::uint32_t part = 0; part < 3; ++part) {
            geometry::SurfacePatch patch;
            display::add_ball(patch, Vec3(0.008 * part, 0.0, 0.0), 0.01, colour);
            meshes.set_part(mesh, part, patch);
        }
        picture.meshes.push_back({mesh, {at, {1, 0, 0, 0}}, opacity, true});
    };
    ball({-0.01, 0.0, 0.0}, 1.0, {0.9, 0.1, 0.1});
    ball({0.0, 0.01, 0.005}, 0.4, {0.1, 0.8, 0.1});
    ball({0.01, 0.005, -0.005}, 1.0, {0.1, 0.1, 0.9});
    ball({0.0, -0.01, 0.0}, 0.6, {0.8, 0.8, 0.1});
    picture.meshes[2].is_closed = true;
    picture.meshes[0].shines_through = true;
    picture.points.push_back({{0.0f, -0.012f, 0.0f}, {}, {}});
    picture.bounds.add(Vec3(-0.03));
    picture.bounds.add(Vec3(0.03));
    return picture;
}

void check_steps(SightChoice choice, bool is_clipped) {
    display::PictureMaker maker{64, 64};
    display::SceneRenderer& renderer = maker.renderer();
    display::Picture picture = picture_with(renderer.meshes());
    if (is_clipped) picture.clip = display::Plane{Vec3(0.0, 0.0, 0.004), {0.0, 0.0, 1.0}};
    display::OrbitCamera camera;
    camera.look_from(display::NamedView::front);
    camera.fit(picture.bounds, 1.5);
    Sight sight(std::move(choice));
    SceneScreens screens;
    screens.lay_out(sight, 240, 160);
    screens.aim(sight, camera, picture.bounds);
    screens.draw(renderer, picture, sight, {});
    const std::vector<std::uint8_t> whole = pixels(screens.tiles()[0]);
    const std::size_t triangles = renderer.drawn_triangles();
    CHECK_FALSE(screens.has_steps_left());

    // Until the last step the picture before is shown.
    display::Picture empty;
    screens.draw(renderer, empty, sight, {});
    const std::uint64_t version = screens.tiles()[0].version;
    for (int i = 0; i < 20; ++i) screens.took(1.0);  // as short as they get
    screens.begin_steps();
    int steps = 0;
    std::size_t drawn = 0;
    for (; screens.has_steps_left() && steps < 1000; ++steps) {
        CHECK(screens.tiles()[0].version == version);
        screens.draw_step(renderer, picture);
        CHECK(renderer.drawn_triangles() <= 2'000 + 2 * renderer.meshes().triangles(picture.meshes[0].mesh));
        drawn += renderer.drawn_triangles();
    }
    CHECK(steps > 3);
    CHECK(drawn == triangles);
    CHECK(screens.tiles()[0].version != version);
    CHECK(pixels(screens.tiles()[0]) == whole);

    // What begins anew in between is whole, too.
    screens.begin_steps();
    screens.draw_step(renderer, picture);
    screens.draw(renderer, empty, sight, {});
    CHECK_FALSE(screens.has_steps_left());
    screens.begin_steps();
    while (screens.has_steps_left()) screens.draw_step(renderer, picture);
    CHECK(pixels(screens.tiles()[0]) == whole);
}

}  // namespace

TEST_CASE(
    "a picture that is drawn in steps has the pixels of one that is drawn at once, and is shown when it is complete") {
    if (!can_render()) return;
    check_steps({}, false);
    check_steps({}, true);
}

TEST_CASE("both eyes of a picture are drawn in steps, too") {
    if (!can_render()) return;
    SightChoice choice;
    choice.stereo = "side-by-side";
    check_steps(choice, false);
    choice.stereo = "anaglyph";
    check_steps(choice, false);
}

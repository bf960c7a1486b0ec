// SPDX-License-Identifier: Apache-2.0
// Bodies of a scene: colours, shapes that are shared or cannot be drawn, picks, paint.
#include "tools/render/scene_model.hpp"

#include "devices/display/picture_maker.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/render/one_ball.hpp"
#include "tools/render/body_surface.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

using namespace tactus;
using namespace tactus::render;
using namespace tactus::test;

TEST_CASE("a body has the colours of the map that is used, and its own again without one") {
    if (!can_render()) return;
    const Ball body;
    observe::Observer observer;
    const auto port =
        observer.open({"case.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(body.scene));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.scenes.push_back({});
    outline.scenes.back().port = "case.scene";
    SceneModel model(outline, observer, maker.renderer());
    display::OrbitCamera camera;
    const auto draw = [&] {
        observer.advance();
        display::Picture& picture = model.update();
        camera.fit(model.bounds(), 1.0);
        const auto views = display::views_of(camera, picture.bounds, 64, 64, display::StereoMode::mono);
        const display::Image image = maker.draw(picture, views);
        const std::uint8_t* const pixel = image.pixel(32, 32);
        return Vec3(pixel[0], pixel[1], pixel[2]);
    };
    const Vec3 own = draw();
    const auto bodies = observer.bodies();
    REQUIRE(bodies.size() == 1);
    const std::size_t vertices =
        make_body_surface(*bodies[0], contact::make_voxmap(bodies[0]->distance), {}, {}).patch.vertices.size();
    const auto use = [&](double distance, double range) {
        auto map = std::make_shared<SurfaceMap>();
        map->distance[7].assign(vertices, static_cast<float>(distance));
        model.use_map(map, range);
        return draw();
    };
    const Vec3 gap = use(0.5e-3, 0.5e-3), wide_range = use(0.5e-3, 50e-3), overlap = use(-0.5e-3, 0.5e-3);
    CHECK(gap.x > 1.8 * gap.z);
    CHECK(overlap.z > 1.8 * overlap.x);
    CHECK(wide_range.z > 0.75 * wide_range.x);
    REQUIRE(model.legend().scales.size() == 2);
    CHECK(model.legend().scales[0].high_text == "0.5");
    // A map of another shape of the body is not used.
    auto other = std::make_shared<SurfaceMap>();
    other->distance[7].assign(vertices - 1, 0.0f);
    model.use_map(other, 1e-3);
    CHECK(draw() == own);
    model.use_map(nullptr, 1e-3);
    CHECK(draw() == own);
    CHECK(model.legend().scales.empty());
}

TEST_CASE("two bodies of one shape are both drawn and listed and a body of two scenes once") {
    if (!can_render()) return;
    Ball both;
    both.scene.count = 2;
    both.scene.objects[1] = both.scene.objects[0];
    both.scene.objects[1].pose.position.x = 0.03;
    both.scene.content_hash = coupling::hash_of(both.scene);
    const Ball one;
    observe::Observer observer;
    const auto first =
        observer.open({"all.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(both.scene));
    const auto second =
        observer.open({"one.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(one.scene));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.scenes = {{"all.scene", {"a.body", "b.body"}, ""}, {"one.scene", {"a.body"}, ""}};
    SceneModel model(outline, observer, maker.renderer());
    observer.advance();
    model.update();
    REQUIRE(model.parts().size() == 2);
    CHECK(model.parts()[0].name == "a");
    CHECK(model.parts()[1].name == "b");
    CHECK(model.bounds().high.x == Approx(0.038).margin(2e-3));
    // They share a mesh, which is not made anew in every picture.
    const std::uint64_t changes = maker.renderer().meshes().changes();
    for (int n = 0; n < 3; ++n) model.update();
    CHECK(maker.renderer().meshes().changes() == changes);
    CHECK(model.parts()[0].colour != model.parts()[1].colour);
}

TEST_CASE("a fragment that the plan hides is listed as hidden there and not drawn") {
    if (!can_render()) return;
    Ball both;
    both.scene.count = 2;
    both.scene.objects[1] = both.scene.objects[0];
    both.scene.objects[1].pose.position.x = 0.03;
    both.scene.objects[0].body = {};
    both.scene.content_hash = coupling::hash_of(both.scene);
    observe::Observer observer;
    // The scene goes through a second node.
    const auto first =
        observer.open({"case.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(both.scene));
    const auto second =
        observer.open({"place.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(both.scene));
    display::PictureMaker maker(64, 64);
    const auto parts_of = [&](const std::string& plan) {
        SceneOutline outline;
        outline.scenes = {{"case.scene", {"a.body", "b.body"}, plan}, {"place.scene", {"a.body", "b.body"}, plan}};
        SceneModel model(outline, observer, maker.renderer());
        observer.advance();
        model.update();
        CHECK(model.bounds().low.x > 0.015);
        return model.parts();
    };
    const std::vector<SceneModel::Part> planned = parts_of("none.plan.json");
    REQUIRE(planned.size() == 2);
    CHECK(planned[0].name == "a");
    CHECK(planned[0].place == 0);
    CHECK(planned[0].is_out_of_plan);
    CHECK(planned[1].name == "b");
    CHECK_FALSE(planned[1].is_out_of_plan);
    // Without a plan an empty place is no part.
    const std::vector<SceneModel::Part> plain = parts_of("");
    REQUIRE(plain.size() == 1);
    CHECK(plain[0].name == "b");
}

TEST_CASE("a body that cannot be drawn is told and the others are drawn") {
    if (!can_render()) return;
    for (const bool is_spread : {false, true}) {
        Ball good, bad;
        bad.field.grid.values[100] = std::numeric_limits<float>::quiet_NaN();
        coupling::Scene scene = good.scene;
        scene.count = 2;
        scene.objects[1] = bad.scene.objects[0];
        scene.objects[1].body.content_hash = 8;
        std::swap(scene.objects[0], scene.objects[1]);
        scene.content_hash = coupling::hash_of(scene);
        observe::Observer observer;
        const auto port = observer.open({"all.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(scene));
        display::PictureMaker maker(64, 64);
        SceneOutline outline;
        outline.scenes = {{"all.scene", {"bad.body", "good.body"}, ""}};
        SceneModel model(outline, observer, maker.renderer());
        if (is_spread) model.spread_work();
        observer.advance();
        for (int n = 0; n < 5000 && (model.parts().empty() || !model.is_fitted()); ++n) {
            REQUIRE_NOTHROW(model.update());
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        REQUIRE(model.parts().size() == 1);
        CHECK(model.parts()[0].name == "good");
        CHECK(model.is_fitted());
        REQUIRE(model.legend().warnings.size() == 1);
        CHECK(model.legend().warnings[0].find("bad is not drawn: ") == 0);
    }
}

TEST_CASE("a pick goes through the box of a chosen part") {
    if (!can_render()) return;
    const Ball body;
    observe::Observer observer;
    const auto port =
        observer.open({"case.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(body.scene));
    constexpr int size = 256;
    display::PictureMaker maker(size, size);
    SceneOutline outline;
    outline.scenes = {{"case.scene", {"a.body"}, ""}};
    SceneModel model(outline, observer, maker.renderer());
    observer.advance();
    model.choose_part("a");
    model.update();
    display::OrbitCamera camera;
    camera.look_from(display::NamedView::front);
    camera.fit(model.bounds(), 1.0);
    int on_ball = 0, beside = 0;
    display::Picture& picture = model.update();
    const auto views = display::views_of(camera, picture.bounds, size, size, display::StereoMode::mono);
    for (int y = 0; y < size; y += 4)
        for (int x = 0; x < size; x += 4)
            if (const auto picked = maker.renderer().pick(picture, views[0], x, y))
                ++(glm::length(picked->position) < 0.009 ? on_ball : beside);
    CHECK(on_ball > 100);
    CHECK(beside == 0);
}

TEST_CASE("paint is on the side that was painted and not on the back of a thin wall") {
    // A wall of 0.6 mm; its upper side is painted.
    volume::Grid wall{{33, 33, 17}, Vec3(-0.004, -0.004, -0.002), Vec3(0.00025), {}};
    for (int k = 0; k < 17; ++k)
        for (int j = 0; j < 33; ++j)
            for (int i = 0; i < 33; ++i) {
                const Vec3 p = glm::abs(wall.position(i, j, k)) - Vec3(0.003, 0.003, 0.0003);
                wall.values.push_back(static_cast<float>(std::max({p.x, p.y, p.z})));
            }
    observe::SeenBody body;
    body.distance = wall;
    for (int j = -4; j <= 4; ++j)
        for (int i = -4; i <= 4; ++i) {
            body.points.emplace_back(0.0005 * i, 0.0005 * j, 0.0003);
            body.labels.push_back(contact::surface_label::fracture);
        }
    const BodySurface made = make_body_surface(body, contact::make_voxmap(wall), Vec3(1.0), Vec3(1.0, 0.0, 0.0));
    CHECK(made.has_paint);
    int above = 0, below = 0;
    for (const geometry::SurfaceVertex& vertex : made.patch.vertices)
        if (vertex.colour[1] < 128) ++(vertex.position[2] > 0.0f ? above : below);
    CHECK(above > 100);
    CHECK(below == 0);
}

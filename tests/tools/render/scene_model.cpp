// SPDX-License-Identifier: Apache-2.0
// When a scene is meshed, what edits and runs change of it, and when a view is fitted.
#include "tools/render/scene_model.hpp"

#include "devices/display/picture_maker.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/held_lane.hpp"
#include "tests/tools/render/one_ball.hpp"
#include "tools/render/body_surface.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <thread>
#include <vector>

using namespace tactus;
using namespace tactus::render;
using namespace tactus::test;

TEST_CASE("a cut is in the next picture, and only its bricks were meshed") {
    if (!can_render()) return;
    volume::Grid density = ball(0.01);
    std::ranges::fill(density.values, 1800.0f);
    volume::BoneEditor editor(ball(0.01), density, {.band = 0.002});
    observe::Observer observer;
    const volume::BoneSnapshot initial = editor.current();
    const auto port =
        observer.open({"carve.bone", at_60_hz, 1}, value::snapshot<volume::BoneSnapshot>, bytes_of(initial));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.bones = {{"carve.bone"}};
    SceneModel model(outline, observer, maker.renderer());
    observer.advance();
    model.update();
    CHECK(model.remeshed_bricks() == static_cast<std::size_t>(editor.layout().brick_count()));
    CHECK(model.triangles() > 5000);
    CHECK(model.bounds().radius() == Approx(0.01 * std::sqrt(3.0)).epsilon(0.02));
    CHECK(model.legend().scales.size() == 1);
    observer.advance();
    model.update();
    CHECK(model.remeshed_bricks() == 0);

    const std::size_t before = model.triangles();
    for (int k = 44; k < 49; ++k)
        for (int j = 20; j < 28; ++j)
            for (int i = 20; i < 28; ++i) editor.set(i, j, k, 0.001f);
    const volume::BoneSnapshot cut = editor.publish();
    port->see(1, bytes_of(cut), 1, 0);
    observer.advance();
    model.update();
    CHECK(model.remeshed_bricks() == editor.changed_bricks().size());
    CHECK(model.remeshed_bricks() < 30);
    CHECK(model.triangles() != before);
}

TEST_CASE("a pose or a force that is not a number is told, and not drawn") {
    if (!can_render()) return;
    observe::Observer observer;
    const Pose good;
    const Wrench none;
    const auto pose = observer.open({"hand.pose", at_60_hz, 1}, value::pose, bytes_of(good));
    const auto wrench = observer.open({"tip.wrench", at_60_hz, 1}, value::wrench, bytes_of(none));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.balls = {{"hand.pose", "", "tip.wrench", 0.005}};
    SceneModel model(outline, observer, maker.renderer());
    model.update();
    CHECK(model.legend().warnings.empty());
    const std::size_t whole = model.triangles();
    CHECK(whole > 100);

    Wrench bad_force;
    bad_force.force.x = std::numeric_limits<double>::infinity();
    wrench->see(0, bytes_of(bad_force), 1, 0);
    model.update();
    REQUIRE(model.legend().warnings.size() == 1);
    CHECK(model.legend().warnings[0].find("tip.wrench") != std::string::npos);
    CHECK(model.triangles() == whole);

    Pose bad;
    bad.position.y = std::numeric_limits<double>::quiet_NaN();
    pose->see(0, bytes_of(bad), 1, 0);
    model.update();
    REQUIRE(model.legend().warnings.size() == 1);
    CHECK(model.legend().warnings[0].find("hand.pose") != std::string::npos);
    CHECK(model.triangles() == 0);
}

TEST_CASE("what an edit took away leaves the picture, and what it brings comes in") {
    if (!can_render()) return;
    observe::Observer observer;
    const Pose here;
    const auto a = observer.open({"a.pose", at_60_hz, 1}, value::pose, bytes_of(here));
    const auto b = observer.open({"b.pose", at_60_hz, 1}, value::pose, bytes_of(here));
    display::PictureMaker maker(64, 64);
    SceneOutline first, second;
    first.balls = {{"a.pose", "", "", 0.005}};
    second.blades = {{"saw", "b.pose", "", {0.04, 0.01, 0.001}}};
    SceneModel model(first, observer, maker.renderer());
    CHECK(model.update().meshes.size() == 2);  // the ball, and the notes
    const std::size_t ball_triangles = model.triangles();
    model.follow(second);
    model.update();
    CHECK(model.triangles() != ball_triangles);
    CHECK(a->watched() == observe::Watch::nothing);
    CHECK(b->watched() == observe::Watch::latest);
    model.follow(first);
    model.update();
    CHECK(model.triangles() == ball_triangles);
}

TEST_CASE("a large mesh that is new delays no picture of a window, and comes to look as when pictures wait for it") {
    if (!can_render()) return;
    volume::Grid distance{{193, 193, 65}, Vec3(-0.048, -0.048, -0.016), Vec3(0.0005), {}};
    for (int k = 0; k < 65; ++k)
        for (int j = 0; j < 193; ++j)
            for (int i = 0; i < 193; ++i) {
                // Waves all over, so that every brick has a surface.
                const Vec3 p = distance.position(i, j, k);
                distance.values.push_back(
                    static_cast<float>(0.4e-3 * std::sin(2e3 * p.x) + p.z * std::cos(600.0 * p.y)));
            }
    volume::Grid density = distance;
    std::ranges::fill(density.values, 1800.0f);
    volume::BoneEditor editor(distance, density, {.band = 0.002});
    const volume::BoneSnapshot initial = editor.current();
    const Ball body;
    observe::Observer observer;
    const auto bone =
        observer.open({"carve.bone", at_60_hz, 1}, value::snapshot<volume::BoneSnapshot>, bytes_of(initial));
    const auto scene =
        observer.open({"case.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(body.scene));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.bones = {{"carve.bone"}};
    outline.scenes.push_back({});
    outline.scenes.back().port = "case.scene";
    SceneModel waits(outline, observer, maker.renderer());
    SceneModel window(outline, observer, maker.renderer());
    window.spread_work();
    observer.advance();
    waits.update();
    const auto bricks = static_cast<std::size_t>(editor.layout().brick_count());
    REQUIRE(waits.remeshed_bricks() == bricks);
    REQUIRE(waits.is_fitted());
    const std::size_t triangles = waits.triangles();

    std::size_t made = 0, most = 0;
    int pictures = 0;
    for (; pictures < 10'000 && (pictures == 0 || !window.is_fitted()); ++pictures) {
        if (pictures > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const std::size_t meshes = window.update().meshes.size();
        if (pictures == 0) {
            // No shreds of a bone, but how far it is.
            for (std::size_t n = 0; n < meshes; ++n) CHECK(window.part_of(n) != "carve");
            REQUIRE_FALSE(window.legend().entries.empty());
            CHECK(window.legend().entries.front().text.find("carve: the surface is being made") == 0);
            CHECK_FALSE(window.is_fitted());
            CHECK(window.triangles() < triangles);
        }
        made += window.remeshed_bricks();
        most = std::max(most, window.remeshed_bricks());
    }
    CHECK(pictures > 1);
    CHECK(made == bricks);
    CHECK(most < bricks);
    CHECK(window.triangles() == triangles);
    CHECK(glm::length(window.bounds().low - waits.bounds().low) < 1e-9);
    CHECK(glm::length(window.bounds().high - waits.bounds().high) < 1e-9);

    // Other colours of a body come later, too; the body stays meanwhile.
    window.colour_part("fragment 1", {0.1, 0.9, 0.2});
    const std::uint64_t changes = maker.renderer().meshes().changes();
    window.update();
    CHECK(window.triangles() == triangles);
    for (int n = 0; n < 10'000 && maker.renderer().meshes().changes() == changes; ++n) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        window.update();
    }
    CHECK(maker.renderer().meshes().changes() > changes);
    CHECK(window.triangles() == triangles);
}

TEST_CASE("bones of files are made one after another and those of a scene that is gone are not made") {
    if (!can_render()) return;
    observe::Observer observer;
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.still_bones = {{"a", "no-a.vdb", ""}, {"b", "no-b.vdb", ""}};
    const test::HeldLane held(analysis::Lane::scene);
    {
        SceneModel model(outline, observer, maker.renderer());
        model.spread_work();
        model.update();
        CHECK(analysis::jobs_waiting(analysis::Lane::scene) == 2);
        CHECK(model.legend().warnings.empty());
    }
}

TEST_CASE("what was hidden and chosen and coloured in a scene stays so in the next run of its patch") {
    if (!can_render()) return;
    const Ball body;
    observe::Observer observer;
    const auto port =
        observer.open({"case.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(body.scene));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.scenes = {{"case.scene", {"a.body"}, ""}};
    observer.advance();
    SceneModel::Look look;
    {
        SceneModel before(outline, observer, maker.renderer());
        before.show_part("a", false);
        before.choose_part("a");
        before.colour_part("a", {0.1, 0.2, 0.3});
        look = before.look();
    }
    SceneModel model(outline, observer, maker.renderer());
    model.use_look(look);
    model.update();
    REQUIRE(model.parts().size() == 1);
    CHECK_FALSE(model.parts()[0].is_shown);
    CHECK(model.parts()[0].colour == Vec3(0.1, 0.2, 0.3));
    CHECK(model.chosen_parts() == std::vector<std::string>{"a"});
}

TEST_CASE("a view is fitted to a body that comes after the hand, too") {
    if (!can_render()) return;
    const Ball body;
    const coupling::Scene none;
    const Pose here;
    observe::Observer observer;
    const auto scene = observer.open({"case.scene", at_60_hz, 1}, value::snapshot<coupling::Scene>, bytes_of(none));
    const auto hand = observer.open({"hand.pose", at_60_hz, 1}, value::pose, bytes_of(here));
    const auto shape = observer.open({"ball.body", at_60_hz, 1}, value::snapshot<coupling::Body>,
                                     bytes_of(body.scene.objects[0].body));
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.balls = {{"hand.pose", "", "", 0.001}};
    outline.scenes.push_back({});
    outline.scenes.back().port = "case.scene";
    SceneModel model(outline, observer, maker.renderer());
    observer.advance();
    model.update();
    CHECK_FALSE(model.is_fitted());
    CHECK(model.bounds().radius() < 0.003);
    scene->see(1, bytes_of(body.scene), 1, 0);
    observer.advance();
    model.update();
    CHECK(model.is_fitted());
    CHECK(model.bounds().radius() > 0.008);
    // What never comes does not keep the bounds from standing still.
    SceneOutline more = outline;
    more.bones = {{"carve.bone"}};
    model.follow(more);
    for (int i = 0; i < 1000; ++i) model.update();
    CHECK(model.is_fitted());
}

// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/scene/scene_model.hpp"

#include "assets/cases/plan_file.hpp"
#include "assets/reconstruct/reconstruction.hpp"
#include "devices/display/picture_maker.hpp"
#include "dsp/reconstruct/flap.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/held_lane.hpp"
#include "tools/picture/scene/body_surface.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::picture;
using tactus::test::can_render;

namespace {

constexpr Flicks at_60_hz = flicks_per_second / 60;

template <class T>
const std::byte* bytes_of(const T& value) {
    return reinterpret_cast<const std::byte*>(&value);
}

volume::Grid ball(double radius) {
    volume::Grid grid{{49, 49, 49}, Vec3(-0.012), Vec3(0.0005), {}};
    for (int k = 0; k < 49; ++k)
        for (int j = 0; j < 49; ++j)
            for (int i = 0; i < 49; ++i)
                grid.values.push_back(static_cast<float>(glm::length(grid.position(i, j, k)) - radius));
    return grid;
}

}  // namespace

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

TEST_CASE("the vessels of a plan's scan are in the picture where they were scanned, until the plan is gone") {
    if (!can_render()) return;
    const TemporaryFolder folder;
    const std::string file = (folder.path / "case.plan.json").string();
    cases::CasePlan plan;
    cases::PlanStep step;
    step.kind = cases::StepKind::vessels;
    step.vessels = std::make_shared<const std::vector<reconstruct::FlapVessel>>(std::vector<reconstruct::FlapVessel>{
        {"carotid", reconstruct::VesselKind::artery, 2e-3, {Vec3(0.0), Vec3(0.02, 0.0, 0.0), Vec3(0.1, 0.0, 0.0)}},
        {"jugular", reconstruct::VesselKind::vein, 4e-3, {Vec3(0.0, 0.01, 0.0), Vec3(0.1, 0.01, 0.0)}}});
    cases::add_step(plan, step);
    cases::save_case_plan(plan, file);
    observe::Observer observer;
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.scenes = {{"case.scene", {}, file}};
    SceneModel model(outline, observer, maker.renderer());
    model.update();
    REQUIRE(model.parts().size() == 2);
    CHECK(model.parts()[0].name == "carotid");
    const std::size_t both = model.triangles();
    CHECK(both > 100);
    CHECK(model.bounds().low.x == Approx(0.0).margin(1e-6));
    CHECK(model.bounds().high.y == Approx(14e-3).margin(0.1e-3));
    model.show_part("jugular", false);
    model.update();
    CHECK(model.triangles() < both);
    model.follow({});
    model.update();
    CHECK(model.parts().empty());
    CHECK(model.triangles() == 0);
}

TEST_CASE("the vessels of a flap are computed beside the pictures, which say so, or pictures wait for them") {
    if (!can_render()) return;
    const std::string file = (tactus::test::library_folder() / "cases/fibula-flap/case.plan.json").string();
    observe::Observer observer;
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.scenes = {{"case.scene", {}, file}};
    SceneModel waits(outline, observer, maker.renderer());
    waits.show_density(false, true);
    waits.update();
    CHECK(waits.legend().warnings.empty());
    std::vector<std::string> names;
    for (const SceneModel::Part& part : waits.parts()) names.push_back(part.name);
    CHECK(names.size() >= 2);

    SceneModel model(outline, observer, maker.renderer());
    model.update();
    REQUIRE(model.legend().warnings.size() == 1);
    CHECK(model.legend().warnings[0].find("computing the vessels") == 0);
    for (int i = 0; i < 6000 && !model.legend().warnings.empty(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        model.update();
    }
    REQUIRE(model.parts().size() == names.size());
    for (std::size_t i = 0; i < names.size(); ++i) CHECK(model.parts()[i].name == names[i]);
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

namespace {

/// A scene of one ball of 8 mm radius, which comes after the hand.
struct Ball {
    contact::Voxmap field = contact::make_voxmap(ball(0.008));
    coupling::Scene scene;

    Ball() {
        scene.count = 1;
        scene.objects[0].body.map = &field;
        scene.objects[0].body.content_hash = 7;
        scene.content_hash = coupling::hash_of(scene);
    }
};

}  // namespace

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
        window.update();
        if (pictures == 0) {
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

TEST_CASE("plates with their screws implants and sites are drawn where the plan has them, and picked by name") {
    if (!can_render()) return;
    auto all = std::make_shared<reconstruct::Reconstruction>();
    all->flap.plates = {{"p1", 7e-3, 2.5e-3, {{-0.02, 0, 0}, {0.02, 0, 0}}, {{0, -1, 0}, {0, -1, 0}}, {}}};
    all->flap.plates[0].screws = {{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 12e-3, 2e-3}};
    all->flap.implants = {{"i1", {0.0, 0.0, 0.05}, {0.0, 0.0, -1.0}, 4e-3, 14e-3}};
    all->flap.sites = {{"facial artery", reconstruct::VesselKind::artery, {0.015, 0.0, 0.03}}};
    observe::Observer observer;
    display::PictureMaker maker(128, 128);
    SceneModel model({}, observer, maker.renderer());
    model.update();
    CHECK(model.parts().empty());
    model.use_hardware(all);
    display::Picture& picture = model.update();
    REQUIRE(model.parts().size() == 3);
    CHECK(model.parts()[0].name == "plate p1");
    CHECK(model.parts()[1].name == "implant i1");
    CHECK(model.parts()[2].name == "site facial artery");
    REQUIRE(model.labels().size() == 1);
    CHECK(model.labels()[0].text == "site facial artery");
    CHECK(glm::length(model.labels()[0].at - Vec3(0.015, 0.0, 0.03)) < 0.2e-3);
    // The plate is 40 mm long, the screw ends 12 mm behind its contour, the implant reaches from 36 to 50 mm.
    CHECK(model.bounds().low.x == Approx(-0.02).margin(2e-4));
    CHECK(model.bounds().high.x == Approx(0.02).margin(2e-4));
    CHECK(model.bounds().high.y == Approx(0.012).margin(1.1e-3));
    CHECK(model.bounds().high.z == Approx(0.05).margin(2.1e-3));
    const auto picked_at = [&](const Vec3& place) {
        display::OrbitCamera camera;
        camera.look_from(display::NamedView::front);
        camera.fit(model.bounds(), 1.0);
        const auto views = display::views_of(camera, picture.bounds, 128, 128, display::StereoMode::mono);
        const auto seen = views[0].projection.seen(place);
        REQUIRE(seen);
        const auto picked =
            maker.renderer().pick(model.update(), views[0], 64.0 * (seen->x + 1.0), 64.0 * (seen->y + 1.0));
        return picked ? model.part_of(picked->mesh) : std::string();
    };
    CHECK(picked_at({0.015, 0.0, 0.0}) == "plate p1");
    CHECK(picked_at({0.0, 0.0, 0.043}) == "implant i1");
    CHECK(picked_at({0.015, 0.0, 0.03}) == "site facial artery");
    CHECK(picked_at({0.015, 0.0, 0.043}).empty());
    model.show_part("plate p1", false);
    CHECK(picked_at({0.015, 0.0, 0.0}).empty());
    // Undo to a plan without: nothing is left.
    model.use_hardware(nullptr);
    model.update();
    CHECK(model.parts().empty());
    // Neither when the plan is gone from the scene, or another one cannot be read.
    for (const std::string gone : {"", "no.plan.json"}) {
        model.use_hardware(all);
        SceneOutline outline;
        outline.scenes = {{"case.scene", {}, gone}};
        model.follow(outline);
        model.update();
        CHECK(model.parts().empty());
    }
}

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
        const test::HeldLane held(study::Lane::scene);
        REQUIRE(wait([&] { return study::jobs_waiting(study::Lane::scene) == 2; }));
        CHECK(scans() == 0);
        CHECK(model.is_reading_density());
    }
    REQUIRE(wait([&] { return !model.is_reading_density(); }));
    CHECK(scans() == 2);
}

TEST_CASE("bones of files are made one after another and those of a scene that is gone are not made") {
    if (!can_render()) return;
    observe::Observer observer;
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.still_bones = {{"a", "no-a.vdb", ""}, {"b", "no-b.vdb", ""}};
    const test::HeldLane held(study::Lane::scene);
    {
        SceneModel model(outline, observer, maker.renderer());
        model.spread_work();
        model.update();
        CHECK(study::jobs_waiting(study::Lane::scene) == 2);
        CHECK(model.legend().warnings.empty());
    }
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

TEST_CASE("vessels and sites of a scene are those of its plan after each step and each undo") {
    if (!can_render()) return;
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path / "case.plan.json";
    const auto plan_of = [](const std::string& vessel) {
        cases::CasePlan plan;
        cases::PlanStep step;
        step.kind = cases::StepKind::vessels;
        step.vessels =
            std::make_shared<const std::vector<reconstruct::FlapVessel>>(std::vector<reconstruct::FlapVessel>{
                {vessel, reconstruct::VesselKind::artery, 2e-3, {Vec3(0.0), Vec3(0.1)}}});
        cases::add_step(plan, step);
        return plan;
    };
    cases::save_case_plan(plan_of("carotid"), file);
    observe::Observer observer;
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.scenes = {{"case.scene", {}, file.string()}};
    SceneModel model(outline, observer, maker.renderer());
    const auto names = [&] {
        model.update();
        std::vector<std::string> all;
        for (const SceneModel::Part& part : model.parts()) all.push_back(part.name);
        return all;
    };
    REQUIRE(names() == std::vector<std::string>{"carotid"});
    using namespace std::chrono_literals;
    const auto begin = std::filesystem::last_write_time(file);
    const std::uint64_t changes = maker.renderer().meshes().changes();
    model.use_plan(file, plan_of("carotid"), begin);
    CHECK(names() == std::vector<std::string>{"carotid"});
    CHECK(maker.renderer().meshes().changes() == changes);  // the same again
    model.use_plan(file, plan_of("jugular"), begin + 1s);
    CHECK(names() == std::vector<std::string>{"jugular"});
    model.use_plan(file, {}, begin + 2s);
    CHECK(names().empty());
}

TEST_CASE("a rope of the patch stands for the vessel of its course and the other vessels of a flap are drawn") {
    if (!can_render()) return;
    const std::filesystem::path folder = tactus::test::library_folder() / "cases/fibula-flap";
    observe::Observer observer;
    display::PictureMaker maker(64, 64);
    SceneOutline outline;
    outline.scenes = {{"case.scene", {}, (folder / "case.plan.json").string()}};
    const auto vessels = [&](std::vector<std::string> courses) {
        outline.ropes.clear();
        for (const std::string& course : courses)
            outline.ropes.push_back({"rope", "rope.rope", course.empty() ? "" : (folder / course).string()});
        SceneModel model(outline, observer, maker.renderer());
        model.show_density(false, true);
        model.update();
        std::vector<std::string> names;
        for (const SceneModel::Part& part : model.parts())
            if (part.name == "artery" || part.name == "vein") names.push_back(part.name);
        return names;
    };
    CHECK(vessels({}) == std::vector<std::string>{"artery", "vein"});
    CHECK(vessels({""}) == std::vector<std::string>{"artery", "vein"});
    CHECK(vessels({"artery.csv"}) == std::vector<std::string>{"vein"});
    CHECK(vessels({"artery.csv", "vein.csv"}).empty());
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

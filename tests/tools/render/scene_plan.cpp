// SPDX-License-Identifier: Apache-2.0
// What a scene shows of a plan: vessels, plates, implants, sites, ropes.
#include "tools/render/scene_model.hpp"

#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "devices/display/picture_maker.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/can_render.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <glm/geometric.hpp>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

using namespace tactus;
using namespace tactus::render;
using tactus::test::can_render;

TEST_CASE("the vessels of a plan's scan are in the picture where they were scanned, until the plan is gone") {
    if (!can_render()) return;
    const TemporaryFolder folder;
    const std::string file = (folder.path / "case.plan.json").string();
    plan::CasePlan plan;
    plan::PlanStep step;
    step.kind = plan::StepKind::vessels;
    step.vessels =
        std::make_shared<const std::vector<reconstruction::FlapVessel>>(std::vector<reconstruction::FlapVessel>{
            {"carotid",
             reconstruction::VesselKind::artery,
             2e-3,
             {Vec3(0.0), Vec3(0.02, 0.0, 0.0), Vec3(0.1, 0.0, 0.0)}},
            {"jugular", reconstruction::VesselKind::vein, 4e-3, {Vec3(0.0, 0.01, 0.0), Vec3(0.1, 0.01, 0.0)}}});
    plan::add_step(plan, step);
    plan::save_case_plan(plan, file);
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

TEST_CASE("plates with their screws implants and sites are drawn where the plan has them, and picked by name") {
    if (!can_render()) return;
    auto all = std::make_shared<reconstruction::Reconstruction>();
    all->flap.plates = {{"p1", 7e-3, 2.5e-3, {{-0.02, 0, 0}, {0.02, 0, 0}}, {{0, -1, 0}, {0, -1, 0}}, {}}};
    all->flap.plates[0].screws = {{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 12e-3, 2e-3}};
    all->flap.implants = {{"i1", {0.0, 0.0, 0.05}, {0.0, 0.0, -1.0}, 4e-3, 14e-3}};
    all->flap.sites = {{"facial artery", reconstruction::VesselKind::artery, {0.015, 0.0, 0.03}}};
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

TEST_CASE("vessels and sites of a scene are those of its plan after each step and each undo") {
    if (!can_render()) return;
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path / "case.plan.json";
    const auto plan_of = [](const std::string& vessel) {
        plan::CasePlan plan;
        plan::PlanStep step;
        step.kind = plan::StepKind::vessels;
        step.vessels =
            std::make_shared<const std::vector<reconstruction::FlapVessel>>(std::vector<reconstruction::FlapVessel>{
                {vessel, reconstruction::VesselKind::artery, 2e-3, {Vec3(0.0), Vec3(0.1)}}});
        plan::add_step(plan, step);
        return plan;
    };
    plan::save_case_plan(plan_of("carotid"), file);
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

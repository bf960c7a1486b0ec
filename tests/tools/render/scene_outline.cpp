// SPDX-License-Identifier: Apache-2.0
#include "tools/render/scene_outline.hpp"

#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/run/load_plan.hpp"

#include <algorithm>
#include <string>

using namespace tactus;
using namespace tactus::render;
using namespace tactus::run;

namespace {

SceneOutline outline_in_library(const std::string& patch) {
    patch::Problems problems;
    PatchChoice choice;
    choice.patch = tactus::test::source_folder().string() + "/assets/library/patches/" + patch + ".toml";
    const auto plan = read_plan(choice, problems);
    REQUIRE(plan);
    return outline_of(*plan);
}

}  // namespace

TEST_CASE("a saw trainer shows a bone, and a blade with its force") {
    const SceneOutline outline = outline_in_library("saw-training");
    REQUIRE(outline.bones.size() == 1);
    CHECK(outline.bones[0].port == "carve.bone");
    REQUIRE(outline.blades.size() == 1);
    // As a guide would hold it.
    CHECK(outline.blades[0].pose == "blade.held");
    CHECK(outline.blades[0].wrench == "blade.wrench");
    CHECK(outline.blades[0].shape.length == Approx(0.04));
    CHECK(outline.handles.empty());
}

TEST_CASE("the hand of a task is where the blade stands before the planned cut") {
    const SceneOutline outline = outline_in_library("saw-task");
    REQUIRE(outline.places.size() == 1);
    CHECK(outline.places[0].device == "hand.pose");
    CHECK(outline.places[0].frame == "plan.placed_frame");
    CHECK(outline.places[0].scale == "place.force_scale");
    CHECK(outline_in_library("saw-training").places.at(0).frame == "place.frame");
}

TEST_CASE("a held fragment is where its coupling says, and the hand where the device is") {
    const SceneOutline outline = outline_in_library("fragments");
    REQUIRE(outline.held.size() == 1);
    CHECK(outline.held[0].scene == "scene.scene");
    CHECK(outline.held[0].pose == "coupling.pose");
    CHECK(outline.held[0].hand == "place.pose");
    CHECK(outline.held[0].grip == "grasp.grip");
    CHECK(outline.held[0].place == "grasp.held");
    REQUIRE(outline.scenes.size() == 1);
    CHECK(outline.scenes[0].bodies == std::vector<std::string>{"still.body", "moving.body"});
    const SceneOutline peg = outline_in_library("peg-in-hole");
    CHECK(peg.held[0].held == 1.0);
    CHECK(peg.held[0].grip_at.position.z == Approx(-0.03));
}

TEST_CASE("the vessels of a reconstruction are ropes, and a planned place is a target") {
    const SceneOutline outline = outline_in_library("planning-reconstruction");
    REQUIRE(outline.ropes.size() == 2);
    CHECK(outline.ropes[0].shape == "artery.rope");
    CHECK(outline.ropes[1].shape == "vein.rope");
    const auto ports = outline.ports();
    CHECK(std::ranges::find(ports, "vein.rope") != ports.end());
    REQUIRE(outline.targets.size() == 1);
    CHECK(outline.targets[0].pose == "planned.target");
    CHECK(outline.targets[0].fits == "planned.fits");
}

TEST_CASE("every patch of the library has something to see, or has no place in space") {
    for (const char* patch : {"fragments", "gripper-on-arm", "gripper-twum", "gripper-wqsm", "peg-in-hole",
                              "pop-through", "press-fragments", "saw-training", "touch-sphere"})
        CHECK_FALSE(outline_in_library(patch).empty());
    const SceneOutline pop = outline_in_library("pop-through");
    REQUIRE(pop.balls.size() == 1);
    CHECK(pop.balls[0].pose == "proxy.proxy");
    CHECK(pop.balls[0].radius == Approx(0.5e-3));
    const auto ports = pop.ports();
    CHECK(std::ranges::find(ports, "") == ports.end());
    CHECK(std::ranges::is_sorted(ports));
}

TEST_CASE("a guide is seen where its parameters and its frame say, and with its force on the hand") {
    patch::Problems problems;
    const auto plan = compile::compile(patch::read_patch(R"(
wires = ["hand.pose -> wall.pose", "hand.pose -> wall.frame", "hand.pose -> way.pose"]
[devices.d]
driver = "simulated"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "d"
[nodes.wall]
type = "plane_guide"
rate = "1 kHz"
point = "0 mm, 0 mm, 10 mm"
normal = "0, 0, 2"
[nodes.way]
type = "path_guide"
rate = "1 kHz"
points = "0 0 0, 10 0 0 mm"
shape = "straight"
)",
                                                         "guides.toml", problems),
                                       nodes::catalogue(), problems);
    REQUIRE(plan);
    const SceneOutline outline = outline_of(*plan);
    REQUIRE(outline.guides.size() == 2);
    const Visual& wall = outline.guides[0].visual;
    CHECK(wall.kind == VisualKind::plane);
    CHECK(wall.at.z == Approx(0.01));
    CHECK(wall.direction.z == Approx(1.0));
    CHECK(wall.frame == "hand.pose");
    CHECK(wall.hand == "hand.pose");
    CHECK(wall.force == "wall.wrench");
    const Visual& way = outline.guides[1].visual;
    CHECK(way.frame.empty());
    REQUIRE(way.points.size() == 2);
    CHECK(way.points[1].x == Approx(0.01));
    // What is seen beside the device's pose is drawn in its place.
    CHECK(outline.handles.empty());
}

TEST_CASE("a task shows its planned cut, a plan its fragments by name, and a burr its ball") {
    const SceneOutline task = outline_in_library("saw-task");
    REQUIRE(task.tasks.size() == 1);
    CHECK(task.tasks[0].path.ends_with(".toml"));
    const SceneOutline plan = outline_in_library("planning-trauma");
    REQUIRE(plan.scenes.size() == 1);
    CHECK(plan.scenes[0].plan.ends_with("case.plan.json"));
    REQUIRE(plan.targets.size() == 1);
    REQUIRE(plan.leads.size() == 1);
    CHECK(plan.leads[0].target == "matcher.target");
    CHECK(plan.leads[0].when == "hand.second");
    const SceneOutline burr = outline_in_library("burr-training");
    REQUIRE(burr.balls.size() == 1);
    CHECK(burr.balls[0].radius > 1e-3);
}

TEST_CASE("a node that declares nothing shows nothing, whatever its ports are called") {
    CHECK(visuals_of(NodeType{}, nullptr).empty());
    for (const NodeType* type : nodes::catalogue())
        if (type->name == "join_pose" || type->name == "voxmap_contact") {
            void* const node = type->create();
            CHECK(visuals_of(*type, node).empty() == (type->name == "join_pose"));
            type->destroy(node);
        }
}

TEST_CASE("sections know the density inside bodies, because their nodes name the bone or the plan") {
    const SceneOutline fragments = outline_in_library("fragments");
    REQUIRE(fragments.scans.size() == 2);
    CHECK(fragments.scans[0].port == "still.body");
    CHECK(fragments.scans[1].port == "moving.body");
    CHECK(fragments.scans[0].path.find(".vdb") != std::string::npos);
    const SceneOutline plan = outline_in_library("planning-trauma");
    REQUIRE(plan.scans.size() == 1);
    CHECK(plan.scans[0].port == "case.scene");
    CHECK(plan.scans[0].path == plan.scenes.at(0).plan);
    // What is drawn is drawn once.
    CHECK(fragments.still_bones.empty());
    CHECK(plan.still_bones.empty());
}

TEST_CASE("a view suits an outline of other sizes and not one of other things") {
    const SceneOutline saw = outline_in_library("saw-training");
    SceneOutline longer = saw;
    longer.blades[0].shape.length *= 2.0;
    CHECK(longer.shows_the_same(saw));
    SceneOutline more = saw;
    more.still_bones.push_back({"jaw", "jaw.vdb", ""});
    CHECK_FALSE(more.shows_the_same(saw));
    CHECK_FALSE(saw.shows_the_same(more));
    CHECK_FALSE(SceneOutline{}.shows_the_same(saw));
}

TEST_CASE("a rope names the course of the vessel that it stands for") {
    const SceneOutline outline = outline_in_library("planning-reconstruction");
    REQUIRE(outline.ropes.size() == 2);
    CHECK(outline.ropes[0].course.ends_with("artery.csv"));
    CHECK(outline.ropes[1].course.ends_with("vein.csv"));
}

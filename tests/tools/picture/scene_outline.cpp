// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/scene/scene_outline.hpp"

#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tools/session/load_plan.hpp"

#include <algorithm>
#include <string>

using namespace tactus;
using namespace tactus::picture;
using namespace tactus::session;

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
    CHECK(outline.blades[0].pose == "place.pose");
    CHECK(outline.blades[0].wrench == "blade.wrench");
    CHECK(outline.blades[0].shape.length == Approx(0.04));
    CHECK(outline.handles.empty());
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

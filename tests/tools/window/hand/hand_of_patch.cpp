// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/hand_of_patch.hpp"

#include "devices/haptic/window_hand.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/virtual_clock.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/document/workbench.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using namespace tactus::window;

namespace {

RunChoice choice_of(const std::filesystem::path& patch, const std::vector<std::string>& settings = {}) {
    RunChoice choice;
    choice.patch = patch.string();
    choice.overrides.settings = settings;
    return choice;
}

std::filesystem::path in_library(const std::string& name) { return library_folder() / "patches" / (name + ".toml"); }

bool has_problem(const Workbench& bench) {
    return std::ranges::any_of(bench.messages(), [](const Message& message) { return message.is_problem; });
}

}  // namespace

TEST_CASE("the window can take the hand of each patch of the library that has one and give it back") {
    int hands = 0;
    for (const auto& entry : std::filesystem::directory_iterator(library_folder() / "patches")) {
        if (entry.path().extension() != ".toml") continue;
        INFO(entry.path().string());
        Workbench bench(choice_of(entry.path()));
        REQUIRE(bench.plan());
        const auto hand = hand_of(*bench.plan());
        CHECK(bench.can_take_hand() == hand.has_value());
        if (!hand) continue;
        ++hands;
        CHECK(hand->moves_by_itself());
        REQUIRE(bench.use_hand_of_window(true));
        CHECK_FALSE(has_problem(bench));
        const auto taken = hand_of(*bench.plan());
        CHECK(taken->driver == "mouse");
        CHECK(taken->nodes == hand->nodes);
        CHECK_FALSE(bench.can_take_hand());
        REQUIRE(bench.use_hand_of_window(false));
        CHECK(hand_of(*bench.plan())->driver == hand->driver);
        // No edit of the patch.
        CHECK_FALSE(bench.has_unsaved_edits());
    }
    CHECK(hands > 8);
}

TEST_CASE("taking the hand of one of two devices leaves the other one") {
    Workbench bench(choice_of(in_library("gripper-on-arm")));
    REQUIRE(bench.use_hand_of_window(true));
    const auto hand = hand_of(*bench.plan());
    CHECK(hand->node == "arm");
    CHECK(hand->nodes == std::vector<std::string>{"arm", "arm_out"});
    for (const compile::ScheduleNode& node : bench.plan()->nodes)
        if (node.name == "finger" || node.name == "motor") CHECK(node.texts.at("device")->value == "gripper");
}

TEST_CASE("a node without a device goes with the hand that the window takes wherever it stands in the file") {
    const Folder folder;
    const auto patch = folder.write("pen.toml",
                                    "wires = [\"hand.pose -> ball.pose\", \"ball.wrench -> out.wrench\"]\n"
                                    "[devices.pen]\ndriver = \"simulated\"\n"
                                    "[nodes.out]\ntype = \"device_output\"\nrate = \"1 kHz\"\n"
                                    "[nodes.ball]\ntype = \"sphere_contact\"\nrate = \"1 kHz\"\n"
                                    "[nodes.hand]\ntype = \"device_input\"\nrate = \"1 kHz\"\n");
    Workbench bench(choice_of(patch));
    REQUIRE(bench.use_hand_of_window(true));
    for (const compile::ScheduleNode& node : bench.plan()->nodes)
        if (node.name != "ball") CHECK(node.texts.at("device")->value == "mouse");
    // Whoever opens the patch again has its own hand.
    CHECK(bench.choice().overrides.settings.empty());
}

TEST_CASE("the run begins again with the hand of the window", "[virtual]") {
    const test::VirtualClock clock;
    const Folder folder;
    ++haptic::window_hand().windows;
    RunChoice choice = choice_of(in_library("touch-sphere"));
    choice.out = folder.path / "out";
    choice.audio = "none";
    choice.json = true;
    Workbench bench(choice);
    const auto runs = [&] {
        for (int i = 0; i < 1000; ++i) {
            bench.tend();
            if (bench.status()->state == RunStatus::State::runs) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    const auto felt_run = [] {
        haptic::FeltHand felt;
        std::uint64_t number = 0;
        haptic::window_hand().felt.read(felt, number);
        return felt.run;
    };
    bench.run();
    REQUIRE(runs());
    const std::int64_t before = felt_run();
    bench.want_hand(true);
    bench.tend();
    CHECK(bench.runs() == 2);
    REQUIRE(runs());
    CHECK(felt_run() == before + 1);
    bench.want_hand(false);
    bench.tend();
    REQUIRE(runs());
    CHECK(felt_run() == before + 1);
    bench.stop();
    --haptic::window_hand().windows;
}

TEST_CASE("the largest force of a hand is the lower limit of its output and its device") {
    for (const auto& entry : std::filesystem::directory_iterator(library_folder() / "patches")) {
        if (entry.path().extension() != ".toml") continue;
        INFO(entry.path().string());
        const Workbench bench(choice_of(entry.path()));
        // The simulated device of the saw states its own.
        const double of_device = entry.path().stem() == "saw-training" ? 25.0 : max_of_device_N;
        for (const compile::ScheduleNode& node : bench.plan()->nodes)
            if (node.type->name == "device_output")
                CHECK(largest_force(*bench.plan()) == std::min(node.params.at("max_force")->value, of_device));
    }
    const auto force = [](const std::vector<std::string>& settings) {
        const Workbench bench(choice_of(in_library("touch-sphere"), settings));
        return largest_force(*bench.plan());
    };
    CHECK(force({"devices.simulated.max_force=3 N"}) == 3.0);
    CHECK(force({"devices.simulated.max_force=30 N", "hand_out.max_force=25 N"}) == 25.0);
}

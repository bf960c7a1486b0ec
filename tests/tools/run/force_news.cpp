// SPDX-License-Identifier: Apache-2.0
// What a person is told about the forces on a hand.
#include "tools/run/force_news.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/background_run.hpp"
#include "tools/run/load_plan.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

void wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

}  // namespace

TEST_CASE("a state of the forces says what, since when, and how to go on") {
    using control::ForceState;
    run::HandForces forces{"hand", "hand_out", ForceState::on, 1.0, {}, 0.0};
    CHECK(forces.text().empty());
    forces.state = ForceState::waits;
    CHECK(forces.text() == "forces return when the hand leaves the bone (since 1.00 s)");
    forces = {"hand", "hand_out", ForceState::returns, 1.6, "no force arrived in time", 1.6};
    CHECK(forces.text() ==
          "no force arrived in time, since 1.60 s: forces return by themselves once ticks were on time for 1 s");
    forces.state = ForceState::by_hand;
    CHECK_THAT(forces.text(), ContainsSubstring("tactus set hand_out.recover="));
    CHECK(forces.text(true).find("tactus set") == std::string::npos);
    for (int n = 0; n <= static_cast<int>(ForceState::never); ++n)
        CHECK(std::string(control::describe(static_cast<ForceState>(n))) != "unknown state");
    CHECK(run::FaultOnRecord{"hand", "no force arrived in time", 1.6, 2.7, 4.25}.text() ==
          "1.60 s to 2.70 s: hand: no force arrived in time, 4.2 N before");
    CHECK_THAT((run::FaultOnRecord{"hand", "x", 1.6, -1.0, 0.0}.text()), ContainsSubstring("from 1.60 s on"));
}

TEST_CASE("what a person is told about forces that are away is true") {
    using control::Fault, control::ForceState;
    run::HandForces forces{"hand", "hand_out", ForceState::returns, 1.6, "no force arrived in time", 1.6};
    SECTION("how long ticks must be on time, where the patch says longer") {
        forces.on_time_s = 10.0;
        CHECK_THAT(forces.text(), ContainsSubstring("once ticks were on time for 10 s"));
    }
    SECTION("a force that was no number: the patch is wrong") {
        forces.state = ForceState::never;
        forces.reason = Fault::not_finite;
        CHECK_THAT(forces.text(), ContainsSubstring("forces stay off in this run; end it and mend the patch"));
    }
    SECTION("a device that stopped: the patch is not to blame") {
        forces.state = ForceState::never;
        forces.reason = Fault::stale_input;
        CHECK_THAT(forces.text(), ContainsSubstring("end it and look after the device"));
    }
    SECTION("a run that refuses 'set' does not name it as the way to go on") {
        forces.state = ForceState::by_hand;
        forces.way = run::LetReturn::by_nothing;
        CHECK_THAT(forces.text(), ContainsSubstring("as --no-edits refuses 'tactus set'"));
        CHECK(forces.text().find("recover") == std::string::npos);
        forces.way = run::LetReturn::by_button;
        CHECK_THAT(forces.text(), ContainsSubstring("by the button in the window"));
    }
    SECTION("a hand whose window is closed does not come back") {
        forces.state =
            GENERATE(control::ForceState::returns, control::ForceState::returns_freed, control::ForceState::by_hand);
        forces.is_windowless = true;
        CHECK_THAT(forces.text(), ContainsSubstring("forces stay off, as that window is closed"));
    }
}

TEST_CASE("a fault that a gripper was told by a wire is cleared at its source, which the text names") {
    const test::Folder folder;
    std::ofstream(folder.path / "gripper.toml") << R"(title = "stuck"
wires = [
  "push.value -> object.force", "push.value -> object.position", "sensor.value -> object.fault",
  "object.velocity -> motor.finger_speed", "object.reason -> motor.fault",
]
[devices.wqsm]
driver = "wqsm_gripper"
[nodes.push]
type = "constant"
rate = "150 Hz"
[nodes.sensor]
type = "constant"
rate = "150 Hz"
number = 6
[nodes.object]
type = "admittance_controller"
rate = "150 Hz"
stiffness = "1 N/mm"
hand_stiffness = "0.38 N/mm"
[nodes.motor]
type = "gripper_output"
rate = "150 Hz"
device = "wqsm"
)";
    compile::AssetCache assets;
    run::PatchChoice choice;
    choice.patch = (folder.path / "gripper.toml").string();
    run::EngineOptions options;
    options.seconds = 0.2;
    run::Engine engine(run::load_plan(choice, assets), options);
    engine.render(1);
    const auto all = run::forces_of(engine);
    REQUIRE(all.size() == 1);
    CHECK(all[0].state == control::ForceState::by_hand);
    CHECK(all[0].node == "object");
    CHECK_THAT(all[0].text(), ContainsSubstring("tactus set object.recover="));
}

TEST_CASE("a trainer that stood still for a moment tells it, and when its forces are on again", "[live]") {
    // On a busy machine ticks may be late again and again: then nothing comes back, as it should be.
    for (int attempt = 1;; ++attempt) {
        const test::Folder folder;
        const auto told = [&] { return test::slurp(folder.path / "run.err"); };
        test::Run run(folder, "saw-training --audio none --no-edits --out " + (folder.path / "out").string());
        const auto has = [&](const char* text) { return told().find(text) != std::string::npos; };
        REQUIRE(test::wait_for([&] { return has("running Saw training"); }));
        wait(3.0);
        const bool was_calm = !has("no force on");
        run.signal(SIGSTOP);
        wait(0.1);
        run.signal(SIGCONT);
        test::wait_for([&] { return has("forces are on again from "); });
        REQUIRE(run.stop(SIGINT) == 0);
        INFO(told());
        const json summary = json::parse(test::slurp(folder.path / "out/summary.json"));
        const json& faults = summary["faults"];
        REQUIRE_FALSE(faults.empty());
        if (!was_calm || faults.size() != 1) {
            if (attempt < 4) continue;
            return test::skip("the machine was too busy to keep the force up but for the one stop");
        }
        CHECK(faults[0]["reason"] == "no force arrived in time");
        const double began = faults[0]["time_s"], over = faults[0]["over_s"];
        CHECK(over - began >= 1.0);
        CHECK(over - began < 1.5);
        CHECK_THAT(told(), ContainsSubstring("no force on 'simulated' at ") &&
                               ContainsSubstring("forces return by themselves once ticks were on time for 1 s") &&
                               ContainsSubstring("forces are on again from "));
        break;
    }
}

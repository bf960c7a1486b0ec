// SPDX-License-Identifier: Apache-2.0
// What a newcomer is told about a patch that does less than was hoped for.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <string>

using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

/// A hand on a ball of 55 mm: it begins at `height` above its middle, in mm.
std::string resting(const std::string& height) {
    return R"(wires = [ "hand.pose -> ball.pose", "ball.wrench -> out.wrench" ]
[devices.arm]
driver = "scripted"
targets = "0 s: 0 0 )" +
           height + R"( mm; 1 s: 0 0 53 mm"
damping = "30 N s/m"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
stiffness = "2 N/mm"
[nodes.out]
type = "device_output"
rate = "1 kHz"
)";
}

constexpr const char* gripper_at_absent_port =
    R"(wires = [ "finger.finger_force -> speed.in", "speed.out -> motor.finger_speed" ]
[devices.serial]
driver = "serial_gripper"
port = "/dev/no-such-port"
)";

constexpr const char* gripper_nodes = R"([nodes.finger]
type = "gripper_input"
rate = "150 Hz"
[nodes.speed]
type = "gain"
rate = "150 Hz"
factor = 0.01
unit = "m/s"
[nodes.motor]
type = "gripper_output"
rate = "150 Hz"
)";

}  // namespace

TEST_CASE("a run whose hand began in contact, so that forces never came on, says so at its end") {
    const Folder folder;
    for (const bool begins_within : {true, false}) {
        const std::string patch = folder.write("ball.toml", resting(begins_within ? "53" : "60")).string();
        const std::string out = (folder.path / (begins_within ? "within" : "above")).string();
        const Outcome run = folder.tactus("render " + patch + " --seconds 1 -o " + out);
        CAPTURE(run.out, run.err);
        REQUIRE(run.code == 0);
        const json summary = json::parse(slurp(out + "/summary.json"));
        CHECK((run.out.find("out: the hand never felt a force. It began in contact") != std::string::npos) ==
              begins_within);
        CHECK(summary.contains("forces_never_engaged") == begins_within);
        if (begins_within) CHECK(summary["forces_never_engaged"]["out"].get<double>() > 2.0);
        CHECK((summary["force"]["engaged_ticks"].get<double>() > 0.0) != begins_within);
    }
}

TEST_CASE("check judges a patch of hardware that is not here, and says that it is not") {
    const Folder folder;
    const std::string text = std::string(gripper_at_absent_port) + gripper_nodes;
    const std::string patch = folder.write("gripper.toml", text).string();
    const Outcome checked = folder.tactus("check " + patch);
    CAPTURE(checked.out, checked.err);
    CHECK(checked.code == 0);
    CHECK_THAT(checked.out, ContainsSubstring("device 'serial' is not here (there is no /dev/no-such-port)"));
    CHECK_THAT(checked.out, ContainsSubstring("3 nodes"));
    // Its settings are judged all the same.
    const std::string wrong =
        folder.write("wrong.toml", std::string(gripper_at_absent_port) + "bauds = 9600\n" + gripper_nodes).string();
    const Outcome refused = folder.tactus("check " + wrong);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, ContainsSubstring("wrong.toml:5:"));
    // A run needs the device.
    CHECK(folder.tactus("render " + patch + " --seconds 1 -o " + (folder.path / "out").string()).code == 2);
}

TEST_CASE("a device that is used at two rates is refused at the node that uses it") {
    const Folder folder;
    const std::string patch =
        folder.write("two.toml", resting("60") + "[nodes.again]\ntype = \"device_input\"\nrate = \"500 Hz\"\n")
            .string();
    const Outcome checked = folder.tactus("check " + patch);
    CAPTURE(checked.err);
    CHECK(checked.code == 2);
    CHECK_THAT(checked.err, ContainsSubstring("two.toml:16:"));
    CHECK_THAT(checked.err, ContainsSubstring("device 'arm' is used in two groups"));
}

TEST_CASE("a node type is shown with what its parameters are when a patch does not say") {
    const Folder folder;
    const std::string out = folder.tactus("nodes device_output").out;
    CHECK_THAT(out, ContainsSubstring("true [true, false]"));
    CHECK_THAT(out, ContainsSubstring("text \"\""));
    const json rows = json::parse(folder.tactus("nodes workspace --json").out)["rows"];
    for (const json& parameter : rows[0]["parameters"])
        if (parameter["name"] == "origin") CHECK(parameter["default"] == "[0 mm, 0 mm, 0 mm]");
}

TEST_CASE("check tells the verdict of the patch's own device from what other devices would feel, and counts one node") {
    const Folder folder;
    const std::string patch = folder.write("ball.toml", resting("60")).string();
    const Outcome checked = folder.tactus("check " + patch);
    CAPTURE(checked.out);
    CHECK(checked.code == 0);
    CHECK_THAT(checked.out, ContainsSubstring("For information, not part of the verdict"));
    CHECK_THAT(checked.out, ContainsSubstring("would be too stiff"));
    CHECK(checked.out.find("TOO STIFF") == std::string::npos);
    const std::string one = folder.write("one.toml", "[nodes.only]\ntype = \"constant\"\nrate = \"1 Hz\"\n").string();
    CHECK_THAT(folder.tactus("check " + one).out, ContainsSubstring("  1 node\n"));
}

TEST_CASE("a live run does not state a speed") {
    const Folder folder;
    const std::string patch =
        folder.write("one.toml", "[nodes.only]\ntype = \"constant\"\nrate = \"100 Hz\"\n").string();
    const Outcome run =
        folder.tactus("run " + patch + " --seconds 0.2 --audio none -o " + (folder.path / "out").string());
    CAPTURE(run.out, run.err);
    CHECK(run.code == 0);
    CHECK_THAT(run.out, ContainsSubstring("0.2 s live, output "));
}

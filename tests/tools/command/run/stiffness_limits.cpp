// SPDX-License-Identifier: Apache-2.0
// What a device states of damping and stiffness, against what a patch asks of it.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>

using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

/// A hand that goes 2 mm into a ball, on a device that states that it can be 5 N/mm stiff.
std::string touch_patch(const std::string& ball, const std::string& damping, const std::string& more = "",
                        const std::string& wire = "") {
    return R"(title = "touch_patch"
wires = [
  "hand.pose   -> ball.pose",
  "ball.wrench -> out.wrench",
  "ball.wrench -> force.in",
  "ball.penetration -> depth.in",
)" + wire +
           R"(]
[devices.simulated]
driver = "scripted"
targets = "0 s: 0 0 57 mm; 0.3 s: 0 0 57 mm; 1 s: 0 0 53 mm; 2 s: 0 0 53 mm"
stiffness = "20 N/mm"
max_stiffness = "5 N/mm"
damping = ")" +
           damping + R"("
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
)" + ball + R"(
[nodes.out]
type = "device_output"
rate = "1 kHz"
max_force = "20 N"
[nodes.force]
type = "record"
rate = "1 kHz"
file = "force.csv"
unit = "N, N m"
[nodes.depth]
type = "record"
rate = "1 kHz"
file = "depth.csv"
unit = "m"
)" + more;
}

const json* row_of(const json& checked, const std::string& from, const std::string& to) {
    for (const json& row : checked["paths"])
        if (row["from"] == from && row["to"] == to) return &row;
    return nullptr;
}

/// The largest number in a column of a CSV file.
double max_in(const std::string& csv, std::size_t column) {
    std::istringstream lines(csv);
    double most = 0.0;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream cells(line);
        std::string cell;
        for (std::size_t c = 0; c <= column && std::getline(cells, cell, ','); ++c) {
        }
        most = std::max(most, std::strtod(cell.c_str(), nullptr));
    }
    return most;
}

}  // namespace

TEST_CASE(
    "check says that stiffness is unknown beyond what a hand damps on a device that states no damping, and what other "
    "devices could feel") {
    const Folder folder;
    const std::string patch = folder.write("touch.toml", touch_patch("stiffness = \"4.5 N/mm\"", "0 N s/m")).string();
    const Outcome asked = folder.tactus("check --json " + patch);
    CAPTURE(asked.out, asked.err);
    const json checked = json::parse(asked.out);
    REQUIRE(row_of(checked, "hand", "out"));
    CHECK(row_of(checked, "hand", "out")->at("ok").is_null());
    const Outcome said = folder.tactus("check " + patch);
    CHECK_THAT(said.out, ContainsSubstring("UNKNOWN: the device states no damping"));
    CHECK_THAT(said.out, ContainsSubstring("is unknown: its device states no damping"));
    CHECK_THAT(said.out, ContainsSubstring("Touch"));
    CHECK(said.code == 0);
    // A light arm hums at 2.2 N/mm, a stiff device does not.
    const std::string soft = folder.write("soft.toml", touch_patch("stiffness = \"2.2 N/mm\"", "0 N s/m")).string();
    const json classes = json::parse(folder.tactus("check --json " + soft).out)["device_classes"];
    CHECK(std::ranges::any_of(classes, [](const json& row) { return row["ok"] == false; }));
    CHECK(std::ranges::any_of(classes, [](const json& row) { return row["ok"] == true; }));
}

TEST_CASE("a stiffness beyond what the device states is refused with the place, and check calls it too stiff") {
    const Folder folder;
    const std::string patch = folder.write("touch.toml", touch_patch("stiffness = \"8 N/mm\"", "30 N s/m")).string();
    const Outcome checked = folder.tactus("check " + patch);
    CHECK(checked.code == 1);
    CHECK_THAT(checked.out, ContainsSubstring("TOO STIFF: the device states 5 N/mm"));
    const Outcome run = folder.tactus("render " + patch + " --seconds 1 --out " + (folder.path / "out").string());
    CAPTURE(run.err);
    CHECK(run.code == 2);
    CHECK_THAT(run.err, ContainsSubstring("touch.toml:20:"));
    CHECK_THAT(run.err, ContainsSubstring("lower it to 5 N/mm"));
}

TEST_CASE("a wire cannot drive a stiffness beyond what the device states") {
    const Folder folder;
    const std::string patch =
        folder
            .write("touch.toml",
                   touch_patch("", "30 N s/m", "[nodes.level]\ntype = \"constant\"\nrate = \"60 Hz\"\nnumber = 19e3\n",
                               "  \"level.value -> ball.stiffness\",\n"))
            .string();
    const Outcome run = folder.tactus("render " + patch + " --seconds 2 --out " + (folder.path / "out").string());
    INFO(run.err);
    REQUIRE(run.code == 0);
    const double depth = max_in(slurp(folder.path / "out/depth.csv"), 1);
    CHECK(depth > 0.5e-3);
    CHECK(max_in(slurp(folder.path / "out/force.csv"), 3) == Approx(5000.0 * depth).epsilon(0.01));
    CHECK(folder.tactus("check " + patch).code == 0);
}

TEST_CASE("check names the law of contact: per area unless the patch gives a stiffness per point") {
    const Folder folder;
    for (const bool by_point : {false, true}) {
        const std::string more =
            "[nodes.ball2]\ntype = \"shape\"\nrate = \"1 kHz\"\n[nodes.scene]\ntype = \"scene\"\n"
            "rate = \"1 kHz\"\n[nodes.coupling]\ntype = \"quasi_static_coupling\"\nrate = \"1 kHz\"\n"
            "stiffness = \"3 N/mm\"\n" +
            std::string(by_point ? "point_stiffness = \"7 N/mm\"\n" : "");
        const std::string unwired = touch_patch("", "30 N s/m", more,
                                                "  \"ball2.body -> scene.a\",\n  \"scene.scene -> coupling.scene\",\n"
                                                "  \"hand.pose -> coupling.device\",\n");
        std::string wired = unwired;
        const std::string wire = "ball.wrench -> out.wrench";
        wired.replace(wired.find(wire), wire.size(), "coupling.wrench -> out.wrench");
        for (const bool is_felt : {true, false}) {
            const std::string patch = folder.write("touch.toml", is_felt ? wired : unwired).string();
            const Outcome asked = folder.tactus("check --json " + patch);
            CAPTURE(asked.out, asked.err, is_felt);
            const json law = json::parse(asked.out)["contact"][0];
            CHECK(law["node"] == "coupling");
            CHECK(law["law"] == (by_point ? "point" : "area"));
            if (by_point) CHECK(law["stiffness_N_per_mm_per_point"] == Approx(7.0));
            else CHECK(law["stiffness_N_per_mm_per_mm2"] == Approx(40.0));
            // A hand feels nothing of a spring whose force goes to no device.
            CHECK(law["is_felt"] == is_felt);
            if (is_felt) CHECK(law["felt_at_most_N_per_mm"] == Approx(3.0));
            else CHECK(law["felt_at_most_N_per_mm"].is_null());
            const std::string text = folder.tactus("check " + patch).out;
            CHECK_THAT(text, ContainsSubstring(by_point ? "per point: 7 N/mm for each" : "per area: 40 N/mm for each"));
            CHECK_THAT(text, ContainsSubstring(is_felt ? "3 N/mm, its spring" : "nothing: no device gets its force"));
        }
    }
}

TEST_CASE("check counts the delay of the device: an omega with a hand of 3 N s/m is stable up to 3.5 N/mm") {
    const Folder folder;
    const auto checked = [&](const std::string& stiffness) {
        std::string text = touch_patch("stiffness = \"" + stiffness + "\"", "3 N s/m");
        const std::string stated = "max_stiffness = \"5 N/mm\"";
        text.replace(text.find(stated), stated.size(), "model = \"omega\"");
        return folder.tactus("check --json " + folder.write("touch.toml", text).string());
    };
    for (const char* stiffness : {"3.4 N/mm", "3.6 N/mm", "6.9 N/mm"}) {
        const Outcome outcome = checked(stiffness);
        CAPTURE(outcome.out, outcome.err);
        const json found = json::parse(outcome.out);
        const json* const row = row_of(found, "hand", "out");
        REQUIRE(row);
        CHECK(row->at("latency_ms").get<double>() == Approx(0.5));
        CHECK(row->at("stiffness_limit_N_per_mm").get<double>() == Approx(3.5));
        CHECK(outcome.code == (std::string(stiffness) == "3.4 N/mm" ? 0 : 1));
    }
}

TEST_CASE("saws, burr and planning are stable on each class of hardware that is named on the command line", "[slow]") {
    const Folder folder;
    for (const char* device : {"touch", "force_dimension", "haply", "mouse"})
        for (const char* patch :
             {"saw-training", "saw-task", "burr-training", "planning-trauma", "planning-reconstruction"}) {
            const Outcome asked = folder.tactus(std::string("check --json ") + patch + " --set hand.device=" + device);
            CAPTURE(device, patch, asked.out, asked.err);
            CHECK(asked.code == 0);
            const json checked = json::parse(asked.out);
            CHECK_FALSE(checked["paths"].empty());
            for (const json& row : checked["paths"])
                if (row.contains("ok")) CHECK(row["ok"] == true);
        }
}

TEST_CASE("a tool's forces are scaled to hardware that is weaker than the patch, unless somebody chose a scale") {
    const Folder folder;
    // An Inverse3 gives 4 N, the saw up to 25 N.
    const Outcome asked = folder.tactus("check saw-training --set hand.device=haply");
    CAPTURE(asked.out, asked.err);
    CHECK_THAT(asked.out + asked.err, ContainsSubstring("blade.device_scale = 0.16"));
    const Outcome chosen = folder.tactus("check saw-training --set hand.device=haply --set blade.device_scale=0.1");
    CHECK_THAT(chosen.out + chosen.err, !ContainsSubstring("blade.device_scale ="));
    // A mouse has no motors.
    const Outcome mouse = folder.tactus("check saw-training --set hand.device=mouse");
    CHECK_THAT(mouse.out + mouse.err, !ContainsSubstring("blade.device_scale"));
}

TEST_CASE("the option --device-scale scales the forces on the device and leaves what is cut") {
    const Folder folder;
    const auto removed = [&](const std::string& options) {
        const Outcome run = folder.tactus("render saw-training --seconds 4 --overwrite --json " + options + " --out " +
                                          (folder.path / "out").string());
        CAPTURE(options, run.err);
        REQUIRE(run.code == 0);
        const json summary = json::parse(run.out);
        return std::pair{summary["carve"]["removed_mm3"].get<double>(), summary["force"]["device_scale"].get<double>()};
    };
    const auto full = removed("");
    const auto half = removed("--device-scale 0.5 --set 'simulated.thrust=3.75 N'");
    CHECK(full.second == 1.0);
    CHECK(half.second == 0.5);
    CHECK(half.first == Approx(full.first).epsilon(0.2));
    const Outcome none =
        folder.tactus("render touch-sphere --seconds 1 --device-scale 0.5 --out " + (folder.path / "none").string());
    CHECK(none.code == 2);
    CHECK_THAT(none.err, ContainsSubstring("needs a saw_blade or a burr"));
}

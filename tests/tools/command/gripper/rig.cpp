// SPDX-License-Identifier: Apache-2.0
// The rig and the gripper patches, as their readers are told to run them.
#include "tests/support/catch.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

json rig(const Folder& folder, const std::string& what, const std::string& out = "out") {
    const Outcome o = folder.tactus("gripper " + what + " --json --out " + (folder.path / out).string());
    INFO(o.err);
    REQUIRE(o.code == 0);
    const json answer = json::parse(o.out);
    CHECK(tactus::test::broken_schema(folder, "gripper", answer) == "");
    return answer;
}

const json& row_of(const json& answer, const std::string& motor, const std::string& object, double rate,
                   double amplitude) {
    for (const json& row : answer["rows"])
        if (row["motor"] == motor && row["object"] == object && row["rate_hz"] == rate &&
            std::abs(row["amplitude_mm"].get<double>() - amplitude) < 1e-9)
            return row;
    FAIL("no such row: " + motor + ", " + object);
    return answer;
}

json rendered(const Folder& folder, const std::string& patch, const std::string& more, int code = 0) {
    const Outcome o =
        folder.tactus("render " + patch + " --overwrite --out " + (folder.path / "out").string() + " " + more);
    INFO(o.err);
    REQUIRE(o.code == code);
    return json::parse(slurp(folder.path / "out/summary.json"));
}

/// Facts and rows of the standard objects at 0.1 Hz, and the files; each finding is judged with at least so many
/// combinations of what is assumed.
void check_rig(const Folder& folder, const json& answer, int judged) {
    const json& facts = answer["facts"];
    CHECK(facts["peak_cord_speed_mm_s"].get<double>() == Approx(157.08).epsilon(1e-3));
    CHECK(facts["saturation_hz"].get<double>() == Approx(0.446).epsilon(0.02));
    CHECK(facts["saturation_closed_form_hz"].get<double>() == Approx(0.446).epsilon(1e-3));
    for (const char* object : {"spring 0.2 N/mm", "spring 1 N/mm", "spring 5 N/mm"}) {
        const json& row = row_of(answer, "wqsm", object, 0.1, 7.0);
        CAPTURE(row.dump());
        CHECK(row["slip"] == false);
        CHECK(row["rendered_stiffness_N_per_mm"].get<double>() ==
              Approx(row["stiffness_N_per_mm"].get<double>()).epsilon(0.02));
    }
    // A traveling wave turns no slower than 30 mm/s: 0.2 mm in a tick, beside 1.9 and 4.6 mm that these springs give way.
    for (const char* object : {"spring 0.2 N/mm", "spring 1 N/mm"}) {
        const json& row = row_of(answer, "twum", object, 0.1, 7.0);
        CAPTURE(row.dump());
        CHECK(row["slip"] == false);
        CHECK(row["rendered_stiffness_N_per_mm"].get<double>() ==
              Approx(row["stiffness_N_per_mm"].get<double>()).epsilon(0.02));
    }
    REQUIRE(facts["findings"].size() == 2);
    for (const json& finding : facts["findings"]) {
        CAPTURE(finding.dump());
        CHECK(finding["holds"] == finding["of"]);
        CHECK(finding["of"] >= judged);
    }
    const json& wall = row_of(answer, "wqsm", "wall", 0.1, 25.0);
    CHECK(wall["slip"] == true);
    CHECK(wall["penetration_mm"] > 0.1);
    CHECK(wall["nrmse"].is_null());
    CHECK(slurp(folder.path / "out/rig.csv").find("motor,object,stiffness_N_per_mm") == 0);
    const std::string page = slurp(folder.path / "out/report.html");
    CHECK(page.find("<svg") != std::string::npos);
    CHECK(page.find("assumed") != std::string::npos);
    CHECK(page.find("http") == page.find("http://www.w3.org"));  // nothing is loaded from elsewhere
}

}  // namespace

TEST_CASE("rig: rows, facts and findings of the thesis, at few rates", "[slow]") {
    const Folder folder;
    folder.write("m.toml",
                 "rates = [\"0.1 Hz\", \"1 Hz\"]\ncycles = 3\n[crossover]\nrates = [\"1 Hz\", \"2 Hz\"]\n"
                 "stiffness = [\"1 N/mm\"]\n[assumed.wqsm]\nlag = [\"1 ms\", \"4 ms\"]\n");
    const json answer = rig(folder, "gripper-wqsm --matrix " + (folder.path / "m.toml").string());
    CHECK(answer["rows"].size() == 2 * 6 * 2 * 2);
    check_rig(folder, answer, 2);  // the limits of one assumption
}

TEST_CASE("rig: the whole matrix gives the facts and findings of the thesis over all that is assumed", "[.][long]") {
    const Folder folder;
    const json answer = rig(folder, "gripper-wqsm");
    CHECK(answer["rows"].size() == 2 * 6 * 6 * 2);
    check_rig(folder, answer, 100);
    const json& facts = answer["facts"];
    REQUIRE(facts["crossover"].size() == 3);
    double before = 0.0;
    for (const json& crossover : facts["crossover"]) {
        CAPTURE(crossover.dump());
        CHECK(crossover["rate_hz_low"].get<double>() > before);  // the stiffer, the longer the walking motor leads
        CHECK(crossover["rate_hz_high"] >= crossover["rate_hz_low"]);
        before = crossover["rate_hz_low"];
    }
    int better = 0, compared = 0;
    for (const json& lead : facts["feed_forward"]) {
        if (lead["motor"] != "wqsm" || lead["rate_hz"] > 1.0) continue;
        ++compared;
        better += lead["ratio"] > 1.0;
    }
    CHECK(compared > 10);
    CHECK(better > 0.8 * compared);
}

TEST_CASE("rig: what it measured is judged the same when it is read back, and so is a log with uneven times",
          "[slow]") {
    const Folder folder;
    folder.write(
        "m.toml",
        "rates = [\"0.5 Hz\", \"1.5 Hz\"]\namplitudes = [\"7 mm\"]\n[crossover]\nrates = [\"1 Hz\", \"2 Hz\"]\n"
        "stiffness = [\"1 N/mm\"]\n[assumed.wqsm]\nlag = [\"1 ms\", \"4 ms\"]\n");
    const json first = rig(folder, "gripper-twum --series --matrix " + (folder.path / "m.toml").string());
    const json again = rig(folder, (folder.path / "out/series.csv").string(), "again");
    REQUIRE(first["rows"].size() == again["rows"].size());
    for (std::size_t i = 0; i < first["rows"].size(); ++i) {
        const json &a = first["rows"][i], &b = again["rows"][i];
        CHECK(a["object"] == b["object"]);
        CHECK(a["nrmse"].is_null() == b["nrmse"].is_null());
        if (!a["nrmse"].is_null()) CHECK(a["nrmse"].get<double>() == Approx(b["nrmse"].get<double>()).epsilon(1e-4));
        if (a["nrmse"].is_null()) continue;  // a wall that does not move at all has no stiffness to tell
        CHECK(a["rendered_stiffness_N_per_mm"].get<double>() ==
              Approx(b["rendered_stiffness_N_per_mm"].get<double>()).epsilon(1e-4));
    }
    std::string log =
        "motor,object,stiffness_N_per_mm,damping_Ns_per_mm,rate_hz,amplitude_mm,time_s,force_N,position_mm\n";
    for (int n = 0; n < 1500; ++n) {
        const double t = n / 150.0 + 0.001 * std::sin(n), phase = 2.0 * 3.14159265358979 * 0.5 * t;
        log += "mine,spring,2,0,0.5,10," + std::to_string(t) + "," + std::to_string(3.0 * std::sin(phase)) + "," +
               std::to_string(1.5 * std::sin(phase)) + "\n";
    }
    const json mine = rig(folder, folder.write("log.csv", log).string(), "mine");
    REQUIRE(mine["rows"].size() == 1);
    CHECK(mine["rows"][0]["rendered_stiffness_N_per_mm"].get<double>() == Approx(2.0).epsilon(1e-3));
    CHECK(mine["rows"][0]["nrmse"] < 5e-3);
    CHECK(mine["notes"].dump().find("has no slip column") != std::string::npos);
}

TEST_CASE("rig: what cannot be judged is refused with a reason") {
    const Folder folder;
    const std::string out = " --out " + (folder.path / "o").string();
    const Outcome no_gripper = folder.tactus("gripper touch-sphere" + out);
    CHECK(no_gripper.code == 2);
    CHECK(no_gripper.err.find("gripper_input") != std::string::npos);
    const Outcome bad_matrix =
        folder.tactus("gripper gripper-wqsm --matrix " + folder.write("m.toml", "rates = [\"1 mm\"]").string() + out);
    CHECK(bad_matrix.code == 2);
    CHECK(bad_matrix.err.find("m.toml:1") != std::string::npos);
    const Outcome no_column = folder.tactus("gripper " + folder.write("x.csv", "time_s,force\n0,1\n").string() + out);
    CHECK(no_column.code == 2);
    CHECK(no_column.err.find("no column") != std::string::npos);
    const Outcome unknown = folder.tactus("gripper gripper-wqsm --matrix " +
                                          folder.write("n.toml", "motors = [\"linear\"]").string() + out);
    CHECK(unknown.code == 2);
    CHECK(unknown.err.find("linear") != std::string::npos);
}

TEST_CASE("render gripper-on-arm: a light weight is lifted and felt, a heavy one slides out", "[slow]") {
    const Folder folder;
    const json light = rendered(folder, "gripper-on-arm", "--seconds 5");
    CAPTURE(light.dump());
    CHECK(light["weight"]["highest_mm"] > 50.0);
    CHECK(light["weight"]["felt_max_N"].get<double>() == Approx(1.96).epsilon(0.35));
    CHECK(light["faults"].empty());
    CHECK(rendered(folder, "gripper-on-arm", "--seconds 5 --set weight.mass=\"2 kg\"")["weight"]["highest_mm"] < 5.0);
}

TEST_CASE("gripper patches: planted faults hold the motor and are told", "[slow]") {
    const Folder folder;
    for (const auto& [fault, words] :
         {std::pair{"nan", "not a finite number"}, {"unplugged", "invalid sample"}, {"stuck", "stood still"}}) {
        const json s = rendered(folder, "gripper-wqsm",
                                "--seconds 6 --set rig.swings=\"1 Hz\" --set rig.peak_to_peak=\"50 mm\" --set "
                                "devices.wqsm.holding_force=\"20 N\" "
                                "--set devices.wqsm.fault=" +
                                    std::string(fault) + " --set devices.wqsm.fault_at=\"2.1 s\"",
                                3);
        CAPTURE(fault, s["object"].dump());
        CHECK(s["object"]["faults"] == 1.0);
        CHECK(s["object"]["fault"].get<std::string>().find(words) != std::string::npos);
        CHECK(s["object"]["held_s"] > 3.0);
        CHECK(s["faults"].dump().find(words) != std::string::npos);
    }
}

TEST_CASE("gripper patches: one hash on any threads and blocks, and live when nothing is late", "[kernel]") {
    const Folder folder;
    for (const char* patch : {"gripper-wqsm", "gripper-twum", "gripper-on-arm"}) {
        const json one = rendered(folder, patch, "--seconds 1 --jobs 1");
        CHECK(rendered(folder, patch, "--seconds 1 --jobs 3 --block random")["output_hash"] == one["output_hash"]);
        const Outcome live =
            folder.tactus("run " + std::string(patch) +
                          " --seconds 1 --dilate 4 --audio none --no-edits --json --overwrite --record " +
                          (folder.path / patch).string() + " --out " + (folder.path / "live").string());
        INFO(live.err);
        REQUIRE(live.code == 0);
        const json summary = json::parse(live.out);
        double decisions = 0.0;
        bool has_150_hz = false;
        for (const json& group : summary["groups"]) {
            decisions +=
                group["misses"].get<double>() + group["skipped"].get<double>() + group["dropped"].get<double>();
            if (group["rate_hz"] == 150.0) {
                has_150_hz = true;
                if (group["skipped"] == 0) CHECK(group["ticks"] == 150);
            }
        }
        CHECK(has_150_hz);
        if (decisions == 0.0) CHECK(summary["output_hash"] == one["output_hash"]);
        const Outcome replay = folder.tactus("replay " + (folder.path / patch).string());
        INFO(replay.out << replay.err);
        CHECK(replay.code == 0);
    }
}

TEST_CASE("run refuses no gripper, render refuses hardware") {
    const Folder folder;
    const Outcome o = folder.tactus("render gripper-wqsm --set finger.device=serial --set motor.device=serial --out " +
                                    (folder.path / "o").string());
    CHECK(o.code == 2);
    CHECK(o.err.find("tactus run") != std::string::npos);
}

// SPDX-License-Identifier: Apache-2.0
// 'tactus score' over whole runs: blades on known paths, hands that differ, and takes.
#include "assets/bone/bone.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/coupling/placement.hpp"
#include "tests/dsp/training/block.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace tactus;
using test::Folder;
using test::Outcome;
using json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// A block of 20 by 24 by 16 mm, and a task: a cut through its middle from above.
void write_block(const Folder& folder, double voxel) {
    bone::Bone block;
    block.name = "block";
    block.distance = test::whole_block(voxel);
    block.density = block.distance;
    for (float& d : block.density.values) d = d < 0.0f ? 1800.0f : 0.0f;
    bone::save_bone(block, folder.path / "block.vdb");
    folder.write("block.toml", R"(format = 1
title = "a block"
bone = "block.vdb"
patch = "guided.toml"
[cut]
kind = "plane"
point = "0 mm, 0 mm, 8 mm"
normal = [0, 1, 0]
feed = [0, 0, -1]
depth = "16 mm"
tolerance = "3 mm"
[limits]
force = "8 N"
)");
}

/// A hand that follows its path exactly: no force acts on it, and the bone is cut at once, so the cut is at the path.
const std::string guided = R"(title = "guided"
wires = [
  "hand.pose -> place.device",
  "place.pose -> plan.pose",
  "place.frame -> plan.frame",
  "plan.placed -> carve.path as batch",
  "plan.placed -> blade.pose",
  "carve.bone -> blade.bone",
  "plan.placed -> task.pose",
  "blade.wrench -> task.force",
  "blade.in_contact -> task.contact",
]
[assets]
task = "block.toml"
bone = "block.vdb"
[devices.rails]
driver = "scripted"
targets = "0 s: 0 0 0 mm; 0.5 s: 4 0 -4 mm; 1 s: -4 0 -10 mm; 1.5 s: 4 0 -16 mm; 2 s: -4 0 -22 mm; 2.5 s: 0 0 -28 mm"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.place]
type = "workspace"
rate = "1 kHz"
[nodes.plan]
type = "plan_frame"
rate = "1 kHz"
task = "task"
[nodes.blade]
type = "blade_contact"
rate = "1 kHz"
height = "30 mm"
[nodes.carve]
type = "carve"
rate = "60 Hz"
source = "bone"
speed = "100 mm/s"
bricks_per_tick = 4096
[nodes.task]
type = "task"
rate = "1 kHz"
task = "task"
)";

json scored(const Folder& folder, const std::string& words) {
    const Outcome o = folder.tactus("score --json " + words);
    INFO(o.err);
    REQUIRE(o.code == 0);
    const json answer = json::parse(o.out);
    CHECK(test::broken_schema(folder, "score", answer) == "");
    return answer;
}

}  // namespace

// Costly: tasks of the library are sawn from begin to end.
TEST_CASE("a blade on a path of known deviation scores within 0.05 mm and 0.2 degrees", "[slow]") {
    for (const auto& [voxel, aside, turns] :
         {std::tuple{0.3 * mm, 0.0, Vec3(0.0)}, std::tuple{0.3 * mm, 0.62, Vec3(1.5, 0.0, 2.5)},
          std::tuple{0.2 * mm, -0.35, Vec3(0.0, 3.0, -1.2)}}) {
        const Folder folder;
        write_block(folder, voxel);
        folder.write("guided.toml", guided);
        const Outcome run = folder.tactus(fmt::format(
            "render {0}/guided.toml --seconds 3 --out {0}/run --set 'place.rotation={2} deg, {3} deg, {4} deg' --set "
            "'place.origin=0 mm, {1} mm, 0 mm'",
            folder.path.string(), aside, turns.x, turns.y, turns.z));
        INFO(run.err);
        REQUIRE(run.code == 0);
        const json score = scored(folder, (folder.path / "run").string());

        // The plane of the blade: through the resting tool and the turned feed, 5 mm above the block.
        const Quat turn = coupling::rotation_xyz(turns * degree);
        const Vec3 normal = turn * Vec3(0.0, 1.0, 0.0), point(0.0, aside * mm, 13 * mm);
        double sum = 0.0, most = 0.0;
        int count = 0;
        for (double x = -10 * mm; x <= 10 * mm; x += 0.1 * mm)
            for (double z = -8 * mm; z <= 8 * mm; z += 0.1 * mm, ++count) {
                const double y = point.y - (normal.x * (x - point.x) + normal.z * (z - point.z)) / normal.y;
                sum += y * y;
                most = std::max(most, std::abs(y));
            }
        INFO("voxel " << voxel << ", aside " << aside << " mm: " << score.dump());
        CHECK(std::abs(score["plane"]["rms_mm"].get<double>() - std::sqrt(sum / count) / mm) < 0.05);
        CHECK(std::abs(score["plane"]["max_mm"].get<double>() - most / mm) < 0.05);
        CHECK(std::abs(score["plane"]["angle_deg"].get<double>() - std::acos(normal.y) / degree) < 0.2);
        CHECK(score["under_mm3"].get<double>() < 0.1);
        CHECK(score["strokes"].get<int>() == 2);
        CHECK(score["validity"] == "not validated");
    }
}

TEST_CASE("the scores of a run have exactly the documented shape", "[slow]") {
    const Folder folder;
    write_block(folder, 0.3 * mm);
    folder.write("guided.toml", guided);
    const std::string out = (folder.path / "run").string();
    REQUIRE(folder.tactus("render " + (folder.path / "guided.toml").string() + " --seconds 3 --out " + out).code == 0);
    const json score = scored(folder, out);
    std::vector<std::string> keys;
    for (const auto& [key, value] : score.items()) keys.push_back(key);
    CHECK(keys == std::vector<std::string>{"breakthrough", "force", "heat_s", "over_mm3", "path_mm", "plane", "seconds",
                                           "spared", "strokes", "under_mm3", "validity", "version"});
    CHECK(score["plane"].size() == 3);
    CHECK(score["force"].size() == 7);
    CHECK(score["force"]["device_scale"] == 1.0);
    CHECK(score["force"].contains("limited"));
    CHECK(score["force"]["shown"].is_number());
    CHECK(score["breakthrough"].size() == 2);
    CHECK(score["heat_s"].is_null());
    CHECK(score["spared"].empty());
    // 7 mm beyond the far side, and no faster than the path of minimum jerk: 6 mm in 0.5 s, 1.875 times the mean.
    CHECK(std::abs(score["breakthrough"]["depth_mm"].get<double>() - 7.0) < 0.3);
    CHECK(std::abs(score["breakthrough"]["speed_mm_per_s"].get<double>() - 22.5) < 2.0);

    const json two =
        scored(folder, out + " " + out + " --reference " + out + " --csv " + out + ".csv --report " + out + ".html");
    REQUIRE(two["rows"].size() == 2);
    CHECK(two["rows"][0]["percentiles"]["plane.rms_mm"] == 50.0);
    CHECK(two["learning"].size() > 5);
    CHECK(two["reference"][0]["n"] == 1);
    const std::string csv = test::slurp(out + ".csv"), page = test::slurp(out + ".html");
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
    CHECK(csv.starts_with("run,trainee,task,plane.rms_mm,"));
    CHECK(csv.find("not validated") != std::string::npos);
    CHECK(page.find("not validated") != std::string::npos);
    CHECK(page.find("Learning curve") != std::string::npos);
}

TEST_CASE("an attempt whose force was away says so, and one whose force nobody recorded does not", "[slow]") {
    const Folder folder;
    write_block(folder, 0.3 * mm);
    const std::string wire = R"("blade.wrench -> task.force",)";
    const auto attempt = [&](const std::string& name, const std::string& instead) {
        std::string patch = guided;
        if (name == "away")
            patch += "[nodes.out]\ntype = \"device_output\"\nrate = \"1 kHz\"\nmax_force = \"0.0001 N\"\n";
        patch.replace(patch.find(wire), wire.size(), instead);
        const std::string file = (folder.path / (name + ".toml")).string(), out = (folder.path / name).string();
        folder.write(name + ".toml", patch);
        REQUIRE(folder.tactus("render " + file + " --seconds 1 --out " + out).code == 0);
        return out;
    };
    constexpr const char* warning = "without force on the hand: do not compare";
    // A limiter that lets next to nothing through, as after a fault.
    const std::string away = attempt("away", "\"blade.wrench -> out.wrench\",\n  \"out.applied -> task.force\",");
    CHECK(scored(folder, away)["force"]["shown"].get<double>() < 0.99);
    CHECK(folder.tactus("score " + away).out.find(warning) != std::string::npos);
    const std::string unsaid = attempt("unsaid", "");
    CHECK(scored(folder, unsaid)["force"]["shown"].is_null());
    CHECK(folder.tactus("score " + unsaid).out.find(warning) == std::string::npos);
}

// Costly: tasks of the library are sawn from begin to end.
TEST_CASE("runs that cannot be scored are refused with what to do", "[slow]") {
    const Folder folder;
    write_block(folder, 0.3 * mm);
    folder.write("guided.toml", guided);
    const std::string here = folder.path.string();
    const auto refusal = [&](const std::string& words) {
        const Outcome o = folder.tactus("score " + words);
        CHECK(o.code == 2);
        return o.err;
    };
    CHECK(refusal(here + "/nowhere").find("there is no such folder") != std::string::npos);
    CHECK(refusal(here).find("neither the results of a run nor a take nor a session") != std::string::npos);
    REQUIRE(folder.tactus("render " + here + "/guided.toml --seconds 1 --out " + here + "/run").code == 0);
    folder.write("task.csv", "");
    const std::string task = test::slurp(folder.path / "block.toml");
    folder.write("block.toml", task + "time = \"9 s\"\n");
    CHECK(refusal(here + "/run").find("has changed since; score with --task") != std::string::npos);
    CHECK(folder.tactus("score " + here + "/run --task " + here + "/block.toml").code == 0);
    folder.write("block.toml", task);
    write_block(folder, 0.2 * mm);
    CHECK(refusal(here + "/run").find("cut another bone than the task's") != std::string::npos);
    // On the same grid, what is left of the task's bone after a run on it.
    write_block(folder, 0.3 * mm);
    fs::copy_file(folder.path / "run/bone.vdb", folder.path / "part.vdb");
    REQUIRE(folder
                .tactus("render " + here + "/guided.toml --seconds 1 --asset bone=" + here + "/part.vdb --out " + here +
                        "/on-part")
                .code == 0);
    const std::string part = refusal(here + "/on-part");
    CHECK(part.find("cut another bone than the task's") != std::string::npos);
    CHECK(std::count(part.begin(), part.end(), '\n') == 1);
    CHECK(folder.tactus("score " + here + "/run").code == 0);
    fs::rename(folder.path / "run/summary.json", folder.path / "run/summary.json.part");
    CHECK(refusal(here + "/run").find("did not come to its end") != std::string::npos);
}

TEST_CASE("a worse hand scores worse in every measure, and a take scores as its run to the bit", "[long]") {
    const Folder folder;
    const std::string here = folder.path.string();
    const auto attempt = [&](const std::string& trainee, const std::string& settings) {
        // With sharp teeth both hands go through the bone.
        const Outcome o = folder.tactus(
            "session fibula-osteotomy --trainee " + trainee + " --out " + here +
            " --offline --seconds 14 --set blade.sharpness=6 --set simulated.stroke_rate='1.5 Hz' " + settings);
        INFO(o.err);
        REQUIRE(o.code == 0);
        return here + "/" + trainee + "/1/01-fibula-osteotomy";
    };
    const std::string good = attempt("good", "--set simulated.feed_speed='8 mm/s'");
    const std::string bad =
        attempt("bad",
                "--set simulated.start_y='1.6 mm' --set simulated.turn='4 deg' --set simulated.thrust='14 N' --set "
                "simulated.tremor='0.3 mm' --set simulated.depth='24 mm' --set simulated.feed_speed='40 mm/s' --set "
                "simulated.stiffness='0.8 N/mm'");
    const json g = scored(folder, good), b = scored(folder, bad);
    INFO(g.dump() << "\n" << b.dump());
    const auto worse = [&](const char* group, const char* key) {
        const json &one = *group ? g[group][key] : g[key], &other = *group ? b[group][key] : b[key];
        INFO(group << " " << key);
        REQUIRE(one.is_number());
        REQUIRE(other.is_number());
        CHECK(other.get<double>() > one.get<double>());
    };
    for (const char* key : {"rms_mm", "max_mm", "angle_deg"}) worse("plane", key);
    for (const char* key : {"mean_N", "over_limit_Ns", "jerk"}) worse("force", key);
    CHECK(g["force"]["shown"].get<double>() > 0.99);
    // The good hand comes through the bone without a plunge.
    for (const char* key : {"depth_mm", "speed_mm_per_s"}) {
        const json& plunge = g["breakthrough"][key];
        CHECK(b["breakthrough"][key].get<double>() > (plunge.is_null() ? 0.0 : plunge.get<double>()));
    }
    worse("", "over_mm3");
    CHECK(g["spared"][0]["injured_mm3"] == 0.0);
    CHECK(b["spared"][0]["injured_mm3"].get<double>() > 0.5);
    CHECK(g["spared"][0]["closest_mm"].get<double>() > b["spared"][0]["closest_mm"].get<double>());

    CHECK(folder.tactus("replay " + good + "/take").code == 0);
    CHECK(scored(folder, good + "/take") == g);
    CHECK(json::parse(test::slurp(good + "/score.json")) == g);
}

// Renders a minute and a half of two tasks.
// Costly: tasks of the library are sawn from begin to end.
TEST_CASE("the hand of the library passes the tasks of the library", "[slow]") {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const Outcome session =
        folder.tactus("session mandible-canal fibula-osteotomy --trainee P01 --offline --out " + out);
    INFO(session.err);
    REQUIRE(session.code == 0);
    // Their limits: see assets/library/tasks.
    for (const auto& [name, margin, time] :
         {std::tuple{"01-mandible-canal", 0.5, 30.0}, std::tuple{"02-fibula-osteotomy", 1.0, 60.0}}) {
        const json score = json::parse(test::slurp(folder.path / "out/P01/1" / name / "score.json"));
        INFO(name << ": " << score.dump());
        CHECK(score["heat_s"].get<double>() < 5.0);
        CHECK(score["force"]["over_limit_Ns"] == 0.0);
        CHECK(score["seconds"].get<double>() < time);
        CHECK(score["over_mm3"].get<double>() < 0.5);
        for (const json& one : score["spared"]) CHECK(one["closest_mm"].get<double>() >= margin);
        CHECK(score["spared"].size() == 1);
    }
    const json fibula = json::parse(test::slurp(folder.path / "out/P01/1/02-fibula-osteotomy/score.json"));
    CHECK(fibula["under_mm3"].get<double>() < 0.5);
}

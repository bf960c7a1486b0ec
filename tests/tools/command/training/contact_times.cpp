// SPDX-License-Identifier: Apache-2.0
// One definition of contact, from the tool to everything that reports of it.
#include "assets/bone/bone.hpp"
#include "dsp/core/constants.hpp"
#include "tests/dsp/training/block.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

using namespace tactus;
using test::Folder;
using json = nlohmann::json;

namespace {

const std::string stroke_patch = R"(title = "recorded stroke"
wires = [
  "hand.pose -> place.device",
  "place.pose -> plan.pose",
  "place.frame -> plan.frame",
  "plan.placed -> blade.pose",
  "carve.bone -> blade.bone",
  "blade.front -> carve.front as batch",
  "plan.placed -> task.pose",
  "blade.wrench -> task.force",
  "blade.in_contact -> task.contact",
  "blade.penetration -> touches.depth",
  "blade.in_contact -> touches.contact",
  "blade.load -> saw.load as linear",
  "blade.in_contact -> saw.contact",
  "saw.cutting -> heard.in",
  "touches.in_contact -> told.in",
  "blade.in_contact -> tool.in",
  "blade.wrench -> force.in",
]
[assets]
task = "block.toml"
bone = "block.vdb"
saw = "saw.toml"
trajectory = "stroke.csv"
[devices.recorded]
driver = "replay"
file = "trajectory"
place = "recorded"
stiffness = "20 N/mm"
damping = "120 N s/m"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "recorded"
[nodes.place]
type = "workspace"
rate = "1 kHz"
[nodes.plan]
type = "plan_frame"
rate = "1 kHz"
task = "task"
[nodes.blade]
type = "saw_blade"
rate = "1 kHz"
stiffness = "40 N/mm"
height = "30 mm"
[nodes.carve]
type = "carve"
rate = "60 Hz"
source = "bone"
[nodes.task]
type = "task"
rate = "1 kHz"
task = "task"
[nodes.touches]
type = "contact_events"
rate = "1 kHz"
[nodes.saw]
type = "saw"
rate = "48 kHz"
saw = "saw"
spin_up = "0 ms"
[nodes.heard]
type = "record"
rate = "1 kHz"
[nodes.told]
type = "record"
rate = "1 kHz"
[nodes.tool]
type = "record"
rate = "1 kHz"
[nodes.force]
type = "record"
rate = "1 kHz"
)";

void write_block(const Folder& folder) {
    bone::Bone block;
    block.name = "block";
    block.distance = test::whole_block(0.3 * mm);
    block.density = block.distance;
    for (float& d : block.density.values) d = d < 0.0f ? 1800.0f : 0.0f;
    bone::save_bone(block, folder.path / "block.vdb");
    folder.write("block.toml", R"(format = 1
title = "a block"
bone = "block.vdb"
[cut]
kind = "plane"
point = "0 mm, 0 mm, 8 mm"
normal = [0, 1, 0]
feed = [0, 0, -1]
depth = "16 mm"
tolerance = "3 mm"
[blade]
height = "30 mm"
)");
}

/// Onto the bone, 0.4 mm of push for 1 s, up, and then beside the cut a hover of a micrometre about the surface, whose
/// forces come and go between nothing and 0.03 N; once in it a touch of 0.4 N; up again.
std::string stroke() {
    std::string table = "t_s,px_mm,py_mm,pz_mm,qx,qy,qz,qw\n";
    const auto eased = [](double t, double from, double to) {
        const double u = std::clamp((t - from) / (to - from), 0.0, 1.0);
        return u * u * (3.0 - 2.0 * u);
    };
    for (int n = 0; n <= 1000; ++n) {
        const double t = 0.005 * n;
        const double height = 2.0 - 2.4 * eased(t, 0.2, 0.8) + 2.4 * eased(t, 1.8, 2.2) - 2.0 * eased(t, 2.4, 2.8) +
                              2.0 * eased(t, 4.4, 4.8);
        const double aside = 5.0 * eased(t, 2.2, 2.4);
        const bool grazes = t > 2.8 && t < 4.4;
        // The blade meets the surface 6 µm above it: its front keeps a little ahead.
        const double hover = grazes ? 6.2e-3 + 1.5e-3 * std::sin(2.0 * std::numbers::pi * 2.5 * (t - 2.8)) : 0.0;
        // Once during the hover it touches in earnest.
        const double touch = -0.02 * eased(t, 3.5, 3.6) * (1.0 - eased(t, 3.7, 3.8));
        table += fmt::format("{:.3f},0,{:.6f},{:.6f},0,0,0,1\n", t, aside, height + hover + touch - 5.0);
    }
    return table;
}

/// Seconds in which the only column of a recorded truth value is 1, at 1 kHz.
double seconds_of(const std::string& table) {
    std::istringstream lines(table);
    double seconds = 0.0;
    for (std::string line; std::getline(lines, line);)
        if (line.ends_with(",1")) seconds += 1e-3;
    return seconds;
}

}  // namespace

TEST_CASE("summary, score, task, events and sound agree on the time of contact of a recorded stroke", "[slow]") {
    const Folder folder;
    write_block(folder);
    folder.write("stroke.csv", stroke());
    folder.write("patch.toml", stroke_patch);
    folder.write("saw.toml",
                 fmt::format("[[recording]]\nfile = \"{}\"\nstate = \"cutting\"\nrate = \"190 Hz\"\nload = \"7 N\"\n",
                             (test::library_folder() / "saw/cutting_190_7N.flac").string()));
    const std::string out = (folder.path / "run").string();
    const test::Outcome run =
        folder.tactus("render " + (folder.path / "patch.toml").string() + " --seconds 5 --out " + out);
    INFO(run.err);
    REQUIRE(run.code == 0);
    const json summary = json::parse(test::slurp(out + "/summary.json"));
    const test::Outcome scored = folder.tactus("score --json " + out);
    INFO(scored.err);
    REQUIRE(scored.code == 0);

    const double tool = seconds_of(test::slurp(out + "/tool.csv"));
    const double events = seconds_of(test::slurp(out + "/told.csv"));
    const double heard = seconds_of(test::slurp(out + "/heard.csv"));
    const double summed = summary["contact"]["seconds"].get<double>();
    const double score = json::parse(scored.out)["force"]["contact_s"].get<double>();
    CAPTURE(tool, events, heard, summed, score);
    // The stroke presses from about 0.6 s to 1.9 s, and touches for about 0.2 s; its residues last for 1.6 s.
    CHECK(tool > 1.2);
    CHECK(tool < 1.9);
    CHECK(events == Approx(tool).margin(1e-9));
    CHECK(summed == Approx(tool).margin(1e-9));
    CHECK(score == Approx(tool).margin(2e-3));
    CHECK(heard == Approx(tool).margin(2e-3));  // the sound reads the contact of the tick before

    // There are residues to be mistaken for contact.
    std::istringstream lines(test::slurp(out + "/force.csv"));
    int forces = 0;
    for (std::string line; std::getline(lines, line);) {
        std::vector<double> v;
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');)
            if (!field.empty() && (std::isdigit(static_cast<unsigned char>(field.back())) != 0))
                v.push_back(std::atof(field.c_str()));
        if (v.size() >= 4) forces += std::abs(v[1]) + std::abs(v[2]) + std::abs(v[3]) > 0.0;
    }
    CHECK(1e-3 * forces > tool + 0.3);
}

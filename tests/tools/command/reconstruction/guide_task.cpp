// SPDX-License-Identifier: Apache-2.0
// From a plan to its guide, to a bone that is sawn in it, to the score: commands alone.
#include "assets/bone/bone.hpp"
#include "assets/training/task_file.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

struct SawCase : test::JawCase {
    std::filesystem::path task = folder.path / "saw.toml";
    json guide;

    SawCase() {
        // Room for slots of 1.5 mm between the segments.
        json with = inputs();
        with["between_space_mm"] = 12.0;
        with["kerf_mm"] = 1.0;
        REQUIRE(run(with).code == 0);
        const test::Outcome made = folder.tactus("plan guide " + plan + " -o " + (folder.path / "guide.stl").string() +
                                                 " --voxel 0.5 --json --task " + task.string());
        INFO(made.err);
        REQUIRE(made.code == 0);
        guide = json::parse(made.out);
    }
    /// Ends the attempts earlier.
    void shorten(const std::string& to) const {
        std::string text = test::slurp(task.string());
        const auto at = text.find("length = \""), end = text.find('\n', at);
        REQUIRE(at != std::string::npos);
        text.replace(at, end - at, "length = \"" + to + "\"");
        std::ofstream(task) << text;
    }
    test::Outcome session(const std::string& more = "") const {
        return folder.tactus("session " + task.string() + " --trainee P01 --offline --out " +
                             (folder.path / "training").string() + " " + more);
    }
    std::filesystem::path attempt() const { return folder.path / "training/P01/1/01-saw"; }
};

}  // namespace

// Costly: makes a guide of four slots, and samples it and its bone.
TEST_CASE("a guide's task has a cut and a slot per osteotomy, each on the plan", "[slow]") {
    const SawCase made;
    const training::Task task = training::load_task(made.task);
    REQUIRE(task.cuts.size() == made.guide["slots"].size());
    REQUIRE(task.slots.size() == task.cuts.size());
    REQUIRE(task.guide_body);
    const bone::Bone bone = bone::load_bone(task.bone);
    CHECK(bone.distance.spacing.x < 1.0 * mm / 3.0);
    for (std::size_t n = 0; n < task.cuts.size(); ++n) {
        const training::PlannedCut& cut = task.cuts[n];
        const json& slot = made.guide["slots"][n];
        CHECK(cut.name == slot["letter"].get<std::string>());
        const json &at = slot["plane"]["origin_mm"], &out = slot["plane"]["normal"];
        const Vec3 origin = mm * Vec3(at[0], at[1], at[2]), normal(out[0], out[1], out[2]);
        CHECK(glm::dot(cut.normal, normal) == Approx(1.0).margin(1e-9));
        // Half a kerf from the plan, where the wall is.
        CHECK(glm::dot(cut.point - origin, normal) == Approx(0.5 * mm).margin(1e-8));
        CHECK(task.slots[n].wall == Approx(-0.5 * mm));
        // Bone of 14 mm, across a cut that is tilted.
        CHECK(cut.depth > 14.0 * mm);
        CHECK(cut.depth < 22.0 * mm);
        // In the slot there is no guide, and beside it there is.
        const auto value = [&](double y, double z) {
            const Vec3 u = (task.slots[n].frame.apply(Vec3(0.0, y, z)) - task.guide_body->distance.origin) /
                           task.guide_body->distance.spacing;
            return task.guide_body->distance.at(static_cast<int>(std::lround(u.x)), static_cast<int>(std::lround(u.y)),
                                                static_cast<int>(std::lround(u.z)));
        };
        CHECK(value(0.5 * task.slots[n].top,
                    0.5 * (task.slots[n].wall + std::min(1.0 * mm, task.slots[n].other_wall))) > 0.0f);
        CHECK(value(0.5 * task.slots[n].top, task.slots[n].wall - 1.0 * mm) < 0.0f);
    }
}

TEST_CASE("plan, guide, saw and score are one sequence of commands", "[long]") {
    const SawCase made;
    made.shorten("38 s");
    const test::Outcome sawn = made.session();
    INFO(sawn.err);
    REQUIRE(sawn.code == 0);
    const json summary = json::parse(test::slurp((made.attempt() / "run/summary.json").string()));
    CHECK(summary["guide"]["seated"] == 1.0);
    CHECK(summary["guide"]["distance_mm"].get<double>() < 0.8);  // the task's seat.tolerance
    const test::Outcome scored = made.folder.tactus("score " + made.attempt().string() + " --json");
    REQUIRE(scored.code == 0);
    const json score = json::parse(scored.out);
    REQUIRE(score["cuts"].size() == made.guide["slots"].size());
    // The first slot is sawn by then, the last is not.
    const json &first = score["cuts"][0], &last = score["cuts"][3];
    const json& slot = made.guide["slots"][0];
    REQUIRE(first["plane"]["max_mm"].is_number());
    CHECK(first["plane"]["rms_mm"].get<double>() < 0.3);
    CHECK(first["plane"]["angle_deg"].get<double>() < slot["play_deg"].get<double>() + 0.2);
    CHECK(first["under_mm3"].get<double>() < 0.2 * last["under_mm3"].get<double>());
    CHECK(last["plane"]["rms_mm"].is_null());
    const std::string printed = made.folder.tactus("score " + made.attempt().string()).out;
    CHECK_THAT(printed,
               Catch::Matchers::Matches("[^]*\n +A +0\\.[0-9]+ mm rms, [0-9.]+ mm at most, [^\n]*from the plan[^]*"));
    CHECK_THAT(printed, Catch::Matchers::Matches("[^]*\n +D +not made[^]*"));
}

// The tutorial on plan, guide and saw. Planes of facing cuts, B with C and D with E, cross near the bone: their slots are
// ledges that are open to each other.
TEST_CASE("every cut of the tutorial's guide is sawn on plan", "[long]") {
    test::Folder folder;
    const auto in = [&](const char* name) { return (folder.path / name).string(); };
    const auto run = [&](const std::string& line) {
        const test::Outcome out = folder.tactus(line);
        INFO(line << ": " << out.err);
        REQUIRE(out.code == 0);
        return out.out;
    };
    run("flap -o " + in("flap"));
    run("plan reconstruct " + in("case.plan.json") + " " + in("flap/INPUTS.json"));
    const json guide = json::parse(run("plan guide " + in("case.plan.json") + " -o " + in("guide.stl") +
                                       " --turn 10 --blade 0.6 --voxel 0.5 --json --task " + in("saw.toml")));
    REQUIRE(guide["slots"].size() == 6);
    run("session " + in("saw.toml") + " --trainee P01 --offline --out " + in("training"));
    const json score = json::parse(run("score " + in("training/P01/1/01-saw") + " --json"));
    REQUIRE(score["cuts"].size() == 6);
    for (const json& cut : score["cuts"]) {
        INFO(cut.dump());
        REQUIRE(cut["plane"]["rms_mm"].is_number());
        CHECK(cut["plane"]["rms_mm"].get<double>() < 0.05);
        CHECK(cut["plane"]["max_mm"].get<double>() < 0.1);
        CHECK(cut["plane"]["angle_deg"].get<double>() < 0.2);
    }
}

// SPDX-License-Identifier: Apache-2.0
// plan assemble: whole cases of broken bones with known truth.
#include "dsp/core/types.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/plan_pose.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>

using namespace tactus;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::pose_in;
using tactus::test::slurp;

namespace {

/// A bone of the library in pieces.
struct Broken {
    Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();

    void break_bone(const std::string& bone, const std::string& name, const std::string& options) const {
        const auto file = test::library_folder() / "bones" / (bone + ".vdb");
        const Outcome made = folder.tactus("fracture " + file.string() + " -o " + (folder.path / name).string() +
                                           " --spread 6 --turn 15 " + options);
        INFO(made.err);
        REQUIRE(made.code == 0);
    }
    std::string piece(const std::string& name, int n) const {
        return " " + name + std::to_string(n) + "=" +
               (folder.path / name / ("fragment_0" + std::to_string(n) + ".vdb")).string();
    }
    void make_plan(const std::string& files) const {
        const Outcome made = folder.tactus("plan new " + plan + files);
        INFO(made.err);
        REQUIRE(made.code == 0);
    }
    Outcome run(const std::string& verb, const std::string& rest = "") const {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    }
    Pose truth(const std::string& name, int n) const {
        const json file = json::parse(slurp(folder.path / name / "truth.json"));
        return pose_in(file["fragments"][static_cast<std::size_t>(n - 1)]["pose"]);
    }
    Pose planned(const std::string& name) const {
        const json shown = json::parse(run("show", "--json").out);
        for (const json& fragment : shown["fragments"])
            if (fragment["name"] == name) return pose_in(fragment["pose"]);
        throw std::runtime_error("no fragment " + name);
    }
    /// How far the fragments that were fitted to each other are from there, worst of all within 20 mm of the middle of
    /// the bone, m.
    double worst(const std::string& name, const json& placed) const {
        const json shown = json::parse(run("show", "--json").out);
        std::map<std::string, Pose> poses;
        for (const json& fragment : shown["fragments"]) poses[fragment["name"]] = pose_in(fragment["pose"]);
        double most = 0.0;
        for (const json& row : placed) {
            const std::string a = row["fragment"], b = row["partner"];
            const Pose a_place = truth(name, a.back() - '0'), b_place = truth(name, b.back() - '0');
            const Pose was = b_place.inverse() * a_place, now = poses.at(b).inverse() * poses.at(a);
            for (const double x : {-20.0, 0.0, 20.0})
                for (const double z : {-20.0, 0.0, 20.0}) {
                    const Vec3 there = a_place.inverse().apply(Vec3(x, 0.0, z) * 1e-3);
                    most = std::max(most, glm::length(now.apply(there) - was.apply(there)));
                }
        }
        return most;
    }
};

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

}  // namespace

// Costly: fits between all fragments of a bone are searched.
TEST_CASE("a jaw in four pieces is put together in one call, undone step by step, and stays when it is done",
          "[slow]") {
    const Broken jaw;
    jaw.break_bone("mandible", "j", "--pieces 4 --seed 11 --chips 10");
    jaw.make_plan(jaw.piece("j", 1) + jaw.piece("j", 2) + jaw.piece("j", 3) + jaw.piece("j", 4));
    const std::string before = slurp(jaw.plan);
    const Outcome done = jaw.run("assemble", "--json");
    INFO(done.out << done.err);
    REQUIRE(done.code == 0);
    const json told = json::parse(done.out);
    CHECK(told["ok"] == true);
    CHECK(told["assemblies"].size() == 1);
    CHECK(told["stays"].empty());
    REQUIRE(told["placed"].size() == 3);
    // The largest stays where it is; what was placed has a residual.
    for (const json& row : told["placed"]) CHECK(row["fragment"] != "j1");
    for (const json& row : told["residuals"]) CHECK(row["rms_mm"].get<double>() < 0.15);
    CHECK(jaw.worst("j", told["placed"]) < 0.3e-3);
    CHECK(jaw.run("check").code == 0);
    // Nothing is left to do.
    const std::string after = slurp(jaw.plan);
    CHECK(jaw.run("assemble").code == 0);
    CHECK(slurp(jaw.plan) == after);
    // Faces inside of a group have a residual, too.
    REQUIRE(jaw.run("group", "j1 j2 j3 j4").code == 0);
    for (const json& row : json::parse(jaw.run("assemble", "--json").out)["residuals"])
        CHECK(row["rms_mm"].is_number());
    REQUIRE(jaw.run("undo").code == 0);
    REQUIRE(jaw.run("undo").code == 0);
    CHECK(jaw.run("check").code == 1);
    REQUIRE(jaw.run("undo", "--steps 2").code == 0);
    for (const char* name : {"j1", "j2", "j3", "j4"}) CHECK(glm::length(jaw.planned(name).position) == 0.0);
    // Where nothing may be written the plan is as it was.
    json file = json::parse(before);
    CHECK(file["steps"].empty());
}

// Costly: fits between all fragments of a bone are searched.
TEST_CASE("a fibula in three pieces is put together, and a piece of another bone stays out with a reason", "[slow]") {
    const Broken fibula;
    fibula.break_bone("fibula", "f", "--pieces 3 --seed 21");
    fibula.break_bone("mandible", "x", "--pieces 6 --seed 31");
    fibula.make_plan(fibula.piece("f", 1) + fibula.piece("f", 2) + fibula.piece("f", 3) + fibula.piece("x", 6));
    const Outcome made = fibula.run("assemble", "--json");
    INFO(made.out << made.err);
    // The stranger is connected to nothing.
    CHECK(made.code == 1);
    const json told = json::parse(made.out);
    REQUIRE(told["placed"].size() == 2);
    CHECK(fibula.worst("f", told["placed"]) < 0.3e-3);
    CHECK(told["assemblies"] == json::array({{"f1", "f2", "f3"}, {"x6"}}));
    REQUIRE(told["stays"].size() == 1);
    CHECK(told["stays"][0]["fragment"] == "x6");
    CHECK(told["stays"][0]["placed"] == false);
    CHECK(told["stays"][0]["reason"].get<std::string>().size() > 20);
    CHECK(glm::length(fibula.planned("x6").position) == 0.0);
    REQUIRE(fibula.run("hide", "x6").code == 0);
    CHECK(fibula.run("assemble").code == 0);
}

TEST_CASE("where the middle piece is missing the others stay apart, and what is locked does not move", "[slow]") {
    const Broken fibula;
    fibula.break_bone("fibula", "f", "--pieces 3 --seed 21");
    fibula.make_plan(fibula.piece("f", 1) + fibula.piece("f", 2) + fibula.piece("f", 3));
    REQUIRE(fibula.run("lock", "f3").code == 0);
    const Outcome whole = fibula.run("assemble", "--json");
    INFO(whole.out << whole.err);
    REQUIRE(whole.code == 0);
    CHECK(glm::length(fibula.planned("f3").position) == 0.0);
    const json placed = json::parse(whole.out)["placed"];
    REQUIRE(placed.size() == 2);
    CHECK(fibula.worst("f", placed) < 0.3e-3);
    const auto ends = [&](std::size_t n) {
        return std::array{placed[n]["fragment"].get<std::string>(), placed[n]["partner"].get<std::string>()};
    };
    const std::string middle = std::ranges::count(ends(1), ends(0)[0]) > 0 ? ends(0)[0] : ends(0)[1];
    REQUIRE(fibula.run("undo", "--steps 3").code == 0);
    REQUIRE(fibula.run("hide", middle).code == 0);
    const Outcome apart = fibula.run("assemble");
    INFO(apart.out << apart.err);
    CHECK(apart.code == 1);
    CHECK(says(apart.out, "stays apart: "));
    CHECK(says(apart.out, "connected to nothing: "));
    for (const char* name : {"f1", "f2", "f3"}) CHECK(glm::length(fibula.planned(name).position) == 0.0);
}

TEST_CASE("a locked fragment is said to be held by its lock only when its partner is locked too", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(test::bar(), file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 5 --turn 10").code ==
            0);
    folder.write("box.stl", test::box_stl(Vec3(50.0, -5.0, -8.0), Vec3(58.0, 5.0, 8.0)));
    const std::string plan = file("case.plan.json");
    const auto run = [&](const std::string& verb, const std::string& rest = "") {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    };
    REQUIRE(
        run("new", "one=" + file("f/fragment_01.vdb") + " two=" + file("f/fragment_02.vdb") + " box=" + file("box.stl"))
            .code == 0);
    // Nothing fits the box, which stands: the others may move, so no lock is to blame.
    REQUIRE(run("lock", "box").code == 0);
    const Outcome apart = run("assemble");
    INFO(apart.out);
    CHECK(apart.code == 1);
    CHECK_FALSE(says(apart.out, "box stays apart"));
    CHECK_FALSE(says(apart.out, "and so is what it would go to"));
    CHECK(says(apart.out, " stay apart: "));
    // The placed fragment with its verdict and score, and its residual over one pair of faces.
    CHECK(std::regex_search(apart.out, std::regex(R"(two +one +fit +1 +0\.9)")));
    CHECK(std::regex_search(apart.out, std::regex(R"(two +0\.0\d\d +\d+ +1\n)")));
    REQUIRE(run("undo", "--steps 2").code == 0);
    REQUIRE(run("hide", "box").code == 0);
    REQUIRE(run("lock", "one two").code == 0);
    const Outcome held = run("assemble");
    INFO(held.out);
    CHECK(held.code == 1);
    CHECK(says(held.out, "it is locked, and so is what it would go to"));
    REQUIRE(run("unlock", "two").code == 0);
    CHECK(run("assemble").code == 0);
}

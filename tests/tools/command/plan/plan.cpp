// SPDX-License-Identifier: Apache-2.0
// The plan of a case from fragments to what other programs read, as scripts do it.
#include "assets/bone/bone.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/types.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/plan_pose.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace tactus;
using nlohmann::json;
using tactus::test::bar;
using tactus::test::box_stl;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::pose_in;
using tactus::test::slurp;

namespace {

/// A case of two boxes, with commands on its plan.
struct Boxes {
    Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();

    Boxes() {
        folder.write("a.stl", box_stl(Vec3(0.0), Vec3(10.0, 12.0, 14.0), false));
        folder.write("b.stl", box_stl(Vec3(11.0, 0.0, 0.0), Vec3(20.0, 12.0, 14.0), false));
        const Outcome made = folder.tactus("plan new " + plan + " " + file("a.stl") + " " + file("b.stl"));
        INFO(made.err);
        REQUIRE(made.code == 0);
    }
    std::string file(const std::string& name) const { return (folder.path / name).string(); }
    Outcome run(const std::string& verb, const std::string& rest = "") const {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    }
    json state() const { return json::parse(run("show", "--json").out); }
};

/// A transform file as ITK means it, read line by line: from the parent's frame, rows of a matrix, then a translation.
struct FromParent {
    double m[3][3], t[3];

    explicit FromParent(const std::string& text) {
        std::istringstream lines(text);
        std::string line;
        bool found = false;
        while (std::getline(lines, line)) {
            if (!line.starts_with("Parameters:")) continue;
            std::istringstream numbers(line.substr(11));
            for (auto& row : m)
                for (double& entry : row) numbers >> entry;
            for (double& entry : t) numbers >> entry;
            found = !numbers.fail();
        }
        REQUIRE(found);
    }
    /// Where the transform's child is, of a place in the parent, mm.
    Vec3 back(const Vec3& p) const {
        Vec3 x;
        for (int row = 0; row < 3; ++row) x[row] = m[row][0] * p.x + m[row][1] * p.y + m[row][2] * p.z + t[row];
        return x;
    }
};

}  // namespace

TEST_CASE("a case is arranged by commands: every step is kept, undone and redone", "[slow]") {
    const Boxes boxes;
    CHECK(boxes.run("move", "b --pose 1,2,3,0,0,0,1").code == 0);
    CHECK(boxes.run("group", "a b --name jaw").code == 0);
    CHECK(boxes.run("lock", "a").code == 0);
    json state = boxes.state();
    CHECK(state["steps_done"] == 3);
    CHECK(state["fragments"][1]["groups"] == json::array({"jaw"}));
    CHECK(state["fragments"][0]["locked"] == true);
    CHECK(state["fragments"][1]["pose"]["position_mm"][1].get<double>() == Approx(2.0));
    const Outcome held = boxes.run("move", "b --pose 0,0,0,1,0,0,0");
    CHECK(held.code == 2);
    CHECK_THAT(held.err, Catch::Matchers::ContainsSubstring("locked"));
    CHECK(boxes.run("undo", "--steps 2").code == 0);
    CHECK(boxes.state()["fragments"][1]["groups"].empty());
    CHECK(boxes.run("alternative", "second").code == 0);
    CHECK(boxes.run("move", "b --pose 0,0,9,1,0,0,0").code == 0);
    CHECK(boxes.state()["steps_to_redo"] == 0);
    CHECK(boxes.run("alternative", "main").code == 0);
    CHECK(boxes.run("redo", "--steps 9").code == 0);
    state = boxes.state();
    CHECK(state["steps_done"] == 3);
    CHECK(state["steps_in_all"] == 4);
    CHECK(state["fragments"][1]["pose"]["position_mm"][2].get<double>() == Approx(3.0));
    CHECK(boxes.run("redo").code == 1);
    CHECK(boxes.run("alternative", "second").code == 0);
    CHECK(boxes.state()["fragments"][1]["pose"]["position_mm"][2].get<double>() == Approx(9.0));
    CHECK(boxes.run("hide", "b").code == 0);
    CHECK(boxes.run("unhide", "b").code == 0);
    CHECK(boxes.run("group", "a b").code == 0);
    CHECK(boxes.run("remove", "b").code == 0);
    CHECK(boxes.state()["groups"].empty());
}

TEST_CASE("exported transforms and landmarks, read by other code, move the scan onto the exported mesh", "[slow]") {
    const Boxes boxes;
    REQUIRE(boxes.run("move", "b --pose 12.5,-3,40,0.5,0.5,-0.5,0.5").code == 0);
    const Outcome done = boxes.run("export", "--json --out " + boxes.file("out"));
    INFO(done.err);
    REQUIRE(done.code == 0);
    const FromParent transform(slurp(boxes.folder.path / "out/b.tfm"));
    // Corners of the exported mesh, carried back, are those of the scan.
    const mesh::Mesh scan = mesh::load_mesh(boxes.file("b.stl")), placed = mesh::load_mesh(boxes.file("out/b.stl"));
    REQUIRE(scan.vertices.size() == 8);
    REQUIRE(placed.vertices.size() == 8);
    for (const Vec3& corner : placed.vertices) {
        double nearest = 1e9;
        for (const Vec3& wanted : scan.vertices)
            nearest = std::min(nearest, glm::length(transform.back(corner) - wanted));
        CHECK(nearest < 1e-4);
    }
    CHECK(slurp(boxes.folder.path / "out/b.stl").substr(0, 80).find("SPACE=LPS") != std::string::npos);
    const json before = json::parse(slurp(boxes.folder.path / "out/b.scan.mrk.json"))["markups"][0],
               after = json::parse(slurp(boxes.folder.path / "out/b.plan.mrk.json"))["markups"][0];
    CHECK(after["coordinateSystem"] == "LPS");
    REQUIRE(before["controlPoints"].size() == 7);
    for (std::size_t n = 0; n < 7; ++n) {
        const auto place = [n](const json& list) {
            const json& p = list["controlPoints"][n]["position"];
            return Vec3(p[0].get<double>(), p[1].get<double>(), p[2].get<double>());
        };
        CHECK(glm::length(transform.back(place(after)) - place(before)) < 1e-9);
    }
    // Rows of the turn of the placed fragment: the transpose of the transform's.
    const json& turn = after["controlPoints"][0]["orientation"];
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            CHECK(turn[3 * row + column].get<double>() == Approx(transform.m[column][row]).margin(1e-12));
    const Pose printed = pose_in(json::parse(done.out)["written"][1]["pose"]);
    CHECK(glm::length(transform.back(printed.apply(Vec3(0.01, 0.02, 0.03)) / mm) - Vec3(10.0, 20.0, 30.0)) < 1e-9);
    CHECK(boxes.run("export", "--format ply --out " + boxes.file("ply")).code == 0);
    CHECK(mesh::load_mesh(boxes.file("ply/a.ply")).vertices.size() == 8);
}

TEST_CASE("hidden fragments are not exported, and the command says which", "[slow]") {
    const Boxes boxes;
    REQUIRE(boxes.run("hide", "b").code == 0);
    const Outcome done = boxes.run("export", "--json --out " + boxes.file("out"));
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(json::parse(done.out)["written"].size() == 1);
    CHECK(json::parse(done.out)["left_out"] == json{"b"});
    CHECK_THAT(boxes.run("export", "--out " + boxes.file("out")).out,
               ContainsSubstring("note: hidden, so not written: b; show them with 'tactus plan unhide'"));
    CHECK(std::filesystem::exists(boxes.file("out/a.stl")));
    CHECK_FALSE(std::filesystem::exists(boxes.file("out/b.stl")));
    REQUIRE(boxes.run("hide", "a").code == 0);
    const Outcome none = boxes.run("export", "--out " + boxes.file("none"));
    CHECK(none.code == 2);
    CHECK_THAT(none.err, Catch::Matchers::ContainsSubstring("no fragment is shown"));
    CHECK_FALSE(std::filesystem::exists(boxes.file("none")));
    REQUIRE(boxes.run("unhide", "a b").code == 0);
    const Outcome both = boxes.run("export", "--json --out " + boxes.file("both"));
    CHECK(both.err.empty());
    CHECK(json::parse(both.out)["written"].size() == 2);
}

TEST_CASE("a name with blanks is one name in every verb of a plan", "[slow]") {
    const Boxes boxes;
    const std::string plan = boxes.file("blank.plan.json"), left = "'left part'", right = "'right part'";
    const auto run = [&](const std::string& verb, const std::string& rest) {
        const Outcome done = boxes.folder.tactus("plan " + verb + " " + plan + " " + rest);
        INFO(verb << " " << rest << "\n" << done.out << done.err);
        CHECK(done.code < 2);
        return done;
    };
    run("new", "'left part=" + boxes.file("a.stl") + "' 'right part=" + boxes.file("b.stl") + "'");
    run("move", right + " --pose -1,0,0,1,0,0,0");
    run("group", left + " " + right + " --name 'both parts'");
    run("ungroup", "'both parts'");
    run("group", left + " " + right);
    CHECK(json::parse(run("show", "--json").out)["groups"][0]["name"] == "group_1");
    run("remove", right);
    for (const char* verb : {"lock", "unlock", "hide", "unhide"}) run(verb, left);
    CHECK(json::parse(run("gap", left + " " + right + " --json").out)["pairs"][0]["fragments"] ==
          json::array({"left part", "right part"}));
    run("repaint", right + " " + boxes.file("b.stl"));
    run("undo", "");
    run("alternative", "'way two'");
    run("alternative", "main");
    run("check", "");
    run("export", "--out " + boxes.file("blank"));
    CHECK(std::filesystem::exists(boxes.file("blank/left part.stl")));
    boxes.folder.write("stroke.json", R"({"radius_mm": 5, "paint": [[11, 6, 7]]})");
    boxes.folder.write("other.json", R"({"radius_mm": 5, "paint": [[10, 6, 7]]})");
    for (const auto& [file, strokes] : {std::pair{"a", "other"}, {"b", "stroke"}})
        REQUIRE(boxes.folder
                    .tactus("fracture-surface " + boxes.file(file + std::string(".stl")) + " -o " +
                            boxes.file("painted " + std::string(file) + ".vdb").insert(0, "'") + "' --paint " +
                            boxes.file(strokes + std::string(".json")))
                    .code == 0);
    run("repaint", left + " '" + boxes.file("painted a.vdb") + "'");
    run("repaint", right + " '" + boxes.file("painted b.vdb") + "'");
    CHECK(json::parse(run("snap", right + " " + left + " --json").out)["fragment"] == "right part");
    run("assemble", "");
    run("mirror", boxes.file("a.stl") + " " + left + " " + right);
    run("report", "");
}

// Costly: each verb of a plan once.
TEST_CASE("broken bone is put together by a plan, measured, and written up on one page", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 5 --turn 10").code ==
            0);
    const json truth = json::parse(slurp(folder.path / "f/truth.json"));
    const std::string plan = file("f/case.plan.json");
    REQUIRE(
        folder.tactus("plan new " + plan + " " + file("f/fragment_01.vdb") + " " + file("f/fragment_02.vdb")).code ==
        0);
    const Outcome snapped = folder.tactus("plan snap " + plan + " fragment_02 --json");
    INFO(snapped.out << snapped.err);
    REQUIRE(snapped.code == 0);
    CHECK(test::broken_schema(folder, "plan-snap", json::parse(snapped.out)) == "");
    const json state = json::parse(folder.tactus("plan show " + plan + " --json").out);
    const json& placed = state["fragments"][1];
    CHECK(placed["fit"]["partner"] == "fragment_01");
    CHECK(placed["fit"]["verdict"] == "fit");
    const Pose found = pose_in(placed["pose"]), wanted = pose_in(truth["fragments"][1]["pose"]);
    for (const Vec3& corner : {Vec3(20.0, 6.0, 11.0), Vec3(20.0, -6.0, -11.0), Vec3(0.0, 0.0, 11.0)}) {
        const Vec3 at = wanted.inverse().apply(corner * mm);
        CHECK(glm::length(found.apply(at) - corner * mm) < 0.2 * mm);
    }
    const json gaps = json::parse(folder.tactus("plan gap " + plan + " --json").out)["pairs"];
    REQUIRE(gaps.size() == 1);
    CHECK(gaps[0]["contact_mm2"].get<double>() > 100.0);
    CHECK(std::abs(gaps[0]["gap_median_mm"].get<double>()) < 0.15);
    CHECK(gaps[0]["overlap_mm3"].get<double>() < 30.0);
    const Outcome report = folder.tactus("plan report " + plan);
    INFO(report.err);
    REQUIRE(report.code == 0);
    const std::string page = slurp(folder.path / "f/case.html");
    CHECK(page.find("data:image/png;base64,iVBOR") != std::string::npos);
    CHECK(page.find("place fragment_02, fit to fragment_01") != std::string::npos);
    CHECK(page.find("src=\"http") == std::string::npos);
    // A file that is not what it was is named, and the plan itself is still shown.
    bone::save_bone(bar(), file("f/fragment_02.vdb"));
    for (const std::string verb : {"snap", "report"}) {
        const Outcome refused = folder.tactus("plan " + verb + " " + plan + (verb == "snap" ? " fragment_02" : ""));
        CHECK(refused.code == 2);
        CHECK_THAT(refused.err, Catch::Matchers::ContainsSubstring("has changed since the plan was made"));
    }
    CHECK(json::parse(folder.tactus("plan show " + plan + " --json").out)["problems"].size() == 1);
}

TEST_CASE("fragments a metre from the origin are planned like any others", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::Bone far = bar();
    for (volume::Grid* grid : {&far.distance, &far.density}) grid->origin += Vec3(1.0, -0.6, 0.8);
    bone::save_bone(far, file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 5 --turn 10").code ==
            0);
    const json truth = json::parse(slurp(folder.path / "f/truth.json"));
    const std::string plan = file("case.plan.json");
    REQUIRE(
        folder.tactus("plan new " + plan + " " + file("f/fragment_01.vdb") + " " + file("f/fragment_02.vdb")).code ==
        0);
    REQUIRE(folder.tactus("plan snap " + plan + " fragment_02 fragment_01").code == 0);
    const json state = json::parse(folder.tactus("plan show " + plan + " --json").out);
    const Pose found = pose_in(state["fragments"][1]["pose"]), wanted = pose_in(truth["fragments"][1]["pose"]);
    const Vec3 at = wanted.inverse().apply(Vec3(1.0, -0.6, 0.8));
    CHECK(glm::length(found.apply(at) - Vec3(1.0, -0.6, 0.8)) < 0.2 * mm);
}

TEST_CASE("paint goes to a file of strokes that a hand may correct, and comes back from it", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 5 --turn 10").code ==
            0);
    json strokes;
    for (const std::string n : {"1", "2"}) {
        const std::string surface = "fracture-surface " + file("f/fragment_0" + n + ".vdb") + " --keep --json -o ";
        const Outcome done = folder.tactus(surface + file(n + ".json"));
        INFO(done.err);
        REQUIRE(done.code == 0);
        const json faces = json::parse(done.out)["faces"];
        REQUIRE_FALSE(faces.empty());
        CHECK(faces[0]["area_mm2"].get<double>() > 150.0);
        strokes = json::parse(slurp(file(n + ".json")));
        CHECK(strokes["paint"].size() > 50);
    }
    const std::string pair = file("f/fragment_02.stl") + " " + file("f/fragment_01.stl");
    const Outcome snapped = folder.tactus("snap " + pair + " --json --paint " + file("2.json") + "," + file("1.json"));
    INFO(snapped.out << snapped.err);
    CHECK(snapped.code == 0);
    CHECK(json::parse(snapped.out)["verdict"] == "fit");
    // A hand takes off what it does not want.
    strokes["erase"] = strokes["paint"];
    folder.write("nothing.json", strokes.dump());
    const std::string again =
        "fracture-surface " + file("f/fragment_02.vdb") + " -o " + file("painted.vdb") + " --paint ";
    CHECK(folder.tactus(again + file("2.json")).code == 0);
    CHECK(folder.tactus(again + file("nothing.json")).code == 1);
    CHECK(folder.tactus(again + folder.write("bad.json", "[]").string()).code == 2);
}

TEST_CASE("what cannot be planned is refused in one line, and nothing is lost", "[slow]") {
    const Boxes boxes;
    const std::string whole = slurp(boxes.plan);
    boxes.folder.write("metres.stl", box_stl(Vec3(0.0), Vec3(0.010, 0.012, 0.014), false));
    boxes.folder.write("open.stl", box_stl(Vec3(0.0), Vec3(10.0, 12.0, 14.0), true));
    std::string fin = box_stl(Vec3(0.0), Vec3(10.0, 12.0, 14.0), false);
    fin.insert(fin.find("endsolid"),
               "facet normal 0 0 0\nouter loop\nvertex 10 0 0\nvertex 10 12 0\nvertex 20 6 0\nendloop\nendfacet\n");
    boxes.folder.write("fin.stl", fin);
    boxes.folder.write("copy.stl", slurp(boxes.file("a.stl")) + "\n");
    boxes.folder.write("cut.plan.json", whole.substr(0, whole.size() / 2));
    std::string later = whole;
    later.replace(later.find("\"version\": 1"), 12, "\"version\": 9");
    boxes.folder.write("later.plan.json", later);
    const std::string fresh = boxes.file("fresh.plan.json");
    const std::pair<std::string, std::string> refused[] = {
        {"new " + boxes.plan + " " + boxes.file("a.stl"), "never overwritten"},
        {"new " + fresh + " " + boxes.file("a.stl") + " a=" + boxes.file("b.stl"),
         "the plan has a fragment 'a' already"},
        {"new " + fresh + " x=" + boxes.file("a.stl") + " y=" + boxes.file("a.stl"),
         "is the same bone as fragment 'x'"},
        {"new " + fresh + " x=" + boxes.file("a.stl") + " y=" + boxes.file("copy.stl"),
         "has the shape and the place of fragment 'x'"},
        {"gap " + boxes.plan + " a a", "two different fragments"},
        {"snap " + boxes.plan + " a a", "'a' cannot be fitted to itself"},
        {"mirror " + boxes.plan + " " + boxes.file("a.stl") + " a a", "'a' is named twice"},
        {"group " + boxes.plan + " a", "needs two fragments that do not move together already"},
        {"new " + fresh + " " + boxes.file("metres.stl"), "--unit"},
        {"new " + fresh + " " + boxes.file("open.stl"), "fragment 'open'"},
        {"new " + fresh + " " + boxes.file("fin.stl"), "fragment 'fin'"},
        {"new " + fresh + " " + boxes.file("none.stl"), "no such file"},
        {"show " + boxes.file("cut.plan.json"), "is cut short"},
        {"undo " + boxes.file("later.plan.json"), "version 9"},
        {"move " + boxes.plan + " b --pose 1,2,3", "--pose"},
        {"move " + boxes.plan + " c --pose 0,0,0,1,0,0,0", "no fragment 'c'"},
        {"ungroup " + boxes.plan + " x", "no group 'x'"},
        {"alternative " + boxes.plan + " main --remove", "it is the current alternative"}};
    for (const auto& [arguments, message] : refused) {
        const Outcome done = boxes.folder.tactus("plan " + arguments);
        INFO(arguments << "\n" << done.err);
        CHECK(done.code == 2);
        CHECK(std::ranges::count(done.err, '\n') == 1);
        CHECK_THAT(done.err, Catch::Matchers::ContainsSubstring(message));
    }
    // A fragment whose file is gone: nothing begins, neither by command nor live.
    std::filesystem::remove(boxes.file("b.stl"));
    for (const std::string& command :
         {"plan gap " + boxes.plan, "plan export " + boxes.plan + " --out " + boxes.file("out"),
          "run planning-trauma --audio none --asset case=" + boxes.plan + " --out " + boxes.file("run")}) {
        const Outcome done = boxes.folder.tactus(command);
        INFO(command << "\n" << done.err);
        CHECK(done.code == 2);
        CHECK(std::ranges::count(done.err, '\n') == 1);
        CHECK_THAT(done.err, Catch::Matchers::ContainsSubstring("fragment 'b'") &&
                                 Catch::Matchers::ContainsSubstring("b.stl is missing"));
    }
    CHECK(slurp(boxes.plan) == whole);
    CHECK(slurp(boxes.file("later.plan.json")) == later);
    CHECK_FALSE(std::filesystem::exists(fresh));
}

// SPDX-License-Identifier: Apache-2.0
// Corrected paint in a plan that has steps already.
#include "tests/support/catch.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

using namespace tactus;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

bool repaint_says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

/// Two boxes in a plan; the second has been moved.
struct Two {
    Folder folder;
    std::string plan = file("case.plan.json");

    Two() {
        folder.write("a.stl", test::box_stl(Vec3(0.0, 0.0, 0.0), Vec3(10.0, 12.0, 14.0)));
        folder.write("b.stl", test::box_stl(Vec3(12.0, 0.0, 0.0), Vec3(22.0, 12.0, 14.0)));
        folder.write("c.stl", test::box_stl(Vec3(12.0, 0.0, 0.0), Vec3(24.0, 12.0, 14.0)));
        folder.write("stroke.json", R"({"radius_mm": 5, "paint": [[12, 6, 7]]})");
        folder.write("other.json", R"({"radius_mm": 5, "paint": [[22, 6, 7]]})");
        paint("b.stl", "painted.vdb", "stroke.json");
        REQUIRE(run("new", file("a.stl") + " " + file("b.stl")).code == 0);
        REQUIRE(run("move", "b --pose -2,0,0,1,0,0,0").code == 0);
    }
    std::string file(const std::string& name) const { return (folder.path / name).string(); }
    void paint(const std::string& from, const std::string& to, const std::string& strokes) const {
        const Outcome made =
            folder.tactus("fracture-surface " + file(from) + " -o " + file(to) + " --paint " + file(strokes));
        INFO(made.err);
        REQUIRE(made.code == 0);
    }
    Outcome run(const std::string& verb, const std::string& rest) const {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    }
    json state() const { return json::parse(run("show", "--json").out); }
};

}  // namespace

TEST_CASE("corrected paint comes into a plan as a step, its poses stay, and undo and redo change the file", "[slow]") {
    const Two two;
    const json before = two.state();
    const Outcome taken = two.run("repaint", "b " + two.file("painted.vdb"));
    INFO(taken.out << taken.err);
    REQUIRE(taken.code == 0);
    CHECK(repaint_says(taken.out, "1 painted face; poses stay"));
    const json after = two.state();
    CHECK(after["fragments"][1]["file"] == "painted.vdb");
    CHECK(after["fragments"][1]["pose"] == before["fragments"][1]["pose"]);
    CHECK(after["steps_in_all"] == 2);
    CHECK(after["problems"].empty());
    CHECK(two.run("gap", "").code == 0);
    const auto file_of_b = [&] { return two.state()["fragments"][1]["file"]; };
    REQUIRE(two.run("undo", "").code == 0);
    CHECK(file_of_b() == "b.stl");
    CHECK(two.state()["fragments"][1]["pose"] == before["fragments"][1]["pose"]);
    CHECK(two.run("gap", "").code == 0);
    REQUIRE(two.run("redo", "").code == 0);
    CHECK(file_of_b() == "painted.vdb");
    // What is loaded is the file of the step: without it nothing is measured, and after undo it is not missed.
    std::filesystem::remove(two.file("painted.vdb"));
    CHECK(two.run("gap", "").code == 2);
    REQUIRE(two.run("undo", "--steps 2").code == 0);
    CHECK(two.run("gap", "").code == 0);
    CHECK(two.state()["fragments"][1]["pose"]["position_mm"][0] == 0.0);
}

TEST_CASE("another bone is not taken for a fragment, and the plan is as it was", "[slow]") {
    const Two two;
    const std::string before = slurp(two.plan);
    // A box that is 2 mm longer, the same box elsewhere, and a file that is none.
    two.folder.write("there.stl", test::box_stl(Vec3(12.0, 1.0, 0.0), Vec3(22.0, 13.0, 14.0)));
    for (const char* other : {"c.stl", "there.stl", "none.stl", "stroke.json"}) {
        const Outcome refused = two.run("repaint", "b " + two.file(other));
        INFO(other << refused.out << refused.err);
        CHECK(refused.code == 2);
        CHECK(repaint_says(refused.err, other));
    }
    CHECK(repaint_says(two.run("repaint", "b " + two.file("c.stl")).err, "it is another bone, or in another place"));
    CHECK(two.run("repaint", "x " + two.file("painted.vdb")).code == 2);
    CHECK(slurp(two.plan) == before);
}

TEST_CASE("a file that was painted anew in its place is taken when one says that the bone is the same", "[slow]") {
    const Two two;
    REQUIRE(two.run("repaint", "b " + two.file("painted.vdb")).code == 0);
    two.paint("b.stl", "painted.vdb", "other.json");
    // Every verb that needs it names the way on.
    const Outcome lost = two.run("gap", "");
    CHECK(lost.code == 2);
    CHECK(repaint_says(lost.err, "'tactus plan repaint'"));
    const Outcome unsure = two.run("repaint", "b " + two.file("painted.vdb"));
    CHECK(unsure.code == 2);
    CHECK(repaint_says(unsure.err, "--same-bone"));
    const Outcome taken = two.run("repaint", "b " + two.file("painted.vdb") + " --same-bone");
    INFO(taken.err);
    REQUIRE(taken.code == 0);
    CHECK(two.run("gap", "").code == 0);
}

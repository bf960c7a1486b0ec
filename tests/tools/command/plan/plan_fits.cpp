// SPDX-License-Identifier: Apache-2.0
// What a plan says about its fits: void ones, connected parts, reasons. The fits are written into the plan's file.
#include "assets/file/whole_file.hpp"
#include "dsp/core/hash.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/pdf_text.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>

using namespace tactus;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

constexpr const char* names[] = {"a", "b", "c", "d"};

/// A case of four boxes in a row, 1 mm from each other.
struct Row {
    Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();

    Row() {
        std::string files;
        for (int n = 0; n < 4; ++n) {
            const std::string file = std::string(names[n]) + ".stl";
            folder.write(file, test::box_stl(Vec3(11.0 * n, 0.0, 0.0), Vec3(11.0 * n + 10.0, 12.0, 14.0)));
            files += " " + (folder.path / file).string();
        }
        const Outcome made = folder.tactus("plan new " + plan + files);
        INFO(made.err);
        REQUIRE(made.code == 0);
    }
    Outcome run(const std::string& verb, const std::string& rest = "") const {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    }
    json state() const { return json::parse(run("show", "--json").out); }
    std::string verdict(int n) const {
        const json fit = state()["fragments"][static_cast<std::size_t>(n)]["fit"];
        return fit.is_null() ? "none" : fit["verdict"].get<std::string>();
    }
    /// Moves a fragment and says in the file that this was a fit.
    void fit(const std::string& fragment, const std::string& partner, const std::string& pose) const {
        REQUIRE(run("move", fragment + " --pose " + pose).code == 0);
        json file = json::parse(slurp(plan));
        file["steps"].back()["fit"] = {{"partner", partner}, {"verdict", "fit"},  {"score", 0.8},
                                       {"margin", 0.5},      {"rms_m", 8e-5},     {"gap_m", 0.0},
                                       {"penetration_m", 0}, {"overlap_m2", 1e-4}};
        folder.write("case.plan.json", file.dump());
    }
};

bool fit_says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

}  // namespace

TEST_CASE("a fit is void when its partner moves away, holds in a moved group, and comes back with undo", "[slow]") {
    const Row row;
    row.fit("b", "a", "-1,0,0,1,0,0,0");
    CHECK(row.verdict(1) == "fit");
    CHECK(fit_says(row.run("show").out, "fit to a (0.08 mm rms)"));
    // Less than 0.05 mm and 0.05 degrees is the same place.
    REQUIRE(row.run("move", "a --pose 0.04,0,0,1,0,0,0").code == 0);
    CHECK(row.verdict(1) == "fit");
    REQUIRE(row.run("move", "a --pose 12,0,0,1,0,0,0").code == 0);
    CHECK(row.verdict(1) == "void");
    const std::string shown = row.run("show").out;
    INFO(shown);
    CHECK(fit_says(shown, "fit to a is void: moved 12.00 mm and 0.00° from it since"));
    CHECK_FALSE(fit_says(shown, "0.08 mm rms"));
    CHECK(row.state()["fragments"][1]["fit"]["moved_since"]["distance_mm"].get<double>() == Approx(12.0));
    REQUIRE(row.run("report").code == 0);
    CHECK(fit_says(slurp(row.folder.path / "case.html"), "fit to a is void"));
    CHECK(row.run("settle").code == 2);
    REQUIRE(row.run("undo", "--steps 2").code == 0);
    CHECK(row.verdict(1) == "fit");
    // The fragment itself counts as its partner does: 0.06 degrees.
    REQUIRE(row.run("move", "b --pose -1,0,0,0.99999986,0,0,0.000523599").code == 0);
    CHECK(row.verdict(1) == "void");
    REQUIRE(row.run("undo").code == 0);
    REQUIRE(row.run("group", "a b --name both").code == 0);
    REQUIRE(row.run("move", "a --pose 30,-20,7,0.5,0.5,-0.5,0.5").code == 0);
    CHECK(row.verdict(1) == "fit");
}

// Costly: fits between fragments are searched.
TEST_CASE("a plan says what is connected to what, and fragments in several parts are not finished", "[slow]") {
    const Row row;
    row.fit("b", "a", "-1,0,0,1,0,0,0");
    row.fit("d", "c", "-1,0,0,1,0,0,0");
    CHECK(row.state()["assemblies"] == json::array({{"a", "b"}, {"c", "d"}}));
    for (const char* verb : {"show", "check", "gap"}) {
        CAPTURE(verb);
        CHECK(test::broken_schema(row.folder, fmt::format("plan-{}", verb), json::parse(row.run(verb, "--json").out)) ==
              "");
    }
    const Outcome shown = row.run("show");
    INFO(shown.out);
    CHECK(shown.code == 0);
    CHECK(fit_says(shown.out, "connected by fits: a, b\n"));
    CHECK(fit_says(shown.out, "connected by fits: c, d\n"));
    const Outcome apart = row.run("check");
    INFO(apart.out);
    CHECK(apart.code == 1);
    CHECK(fit_says(apart.out, "in 2 parts that no fit connects"));
    REQUIRE(row.run("report").code == 0);
    const std::string page = slurp(row.folder.path / "case.html");
    CHECK(fit_says(page, "in 2 parts that no fit connects"));
    // Warnings come first; pictures have the sides of the patient, a scale and the names.
    CHECK(page.find(">Warnings</h2>") < page.find("<td>connections</td>"));
    CHECK(page.find("<td>connections</td>") < page.find("<h2>Fragments"));
    for (const char* written : {">R</text>", ">L</text>", ">S</text>", ">I</text>", " mm</text>", ">d</text>"}) {
        CAPTURE(written);
        CHECK(fit_says(page, written));
    }
    row.fit("c", "b", "-2,0,0,1,0,0,0");
    // It moved from the one that was fitted to it: that fit is void, and d hangs on nothing.
    CHECK(row.state()["assemblies"] == json::array({{"a", "b", "c"}, {"d"}}));
    CHECK(fit_says(row.run("check").out, "d: fit to c is void"));
    row.fit("d", "c", "-3,0,0,1,0,0,0");
    CHECK(row.run("check").code == 0);
    CHECK(json::parse(row.run("check", "--json").out)["ok"] == true);
    REQUIRE(row.run("report").code == 0);
    CHECK_FALSE(fit_says(slurp(row.folder.path / "case.html"), "parts that no fit connects"));
    CHECK_FALSE(fit_says(slurp(row.folder.path / "case.html"), ">Warnings</h2>"));
    REQUIRE(row.run("undo").code == 0);
    CHECK(row.run("check").code == 1);
    REQUIRE(row.run("hide", "d").code == 0);
    CHECK(row.run("check").code == 0);
}

TEST_CASE("a plan is not finished while a fragment lies in another", "[slow]") {
    const Row row;
    // Two millimetres deep, though every fragment is connected by a fit that holds.
    row.fit("b", "a", "-3,0,0,1,0,0,0");
    row.fit("c", "b", "-4,0,0,1,0,0,0");
    row.fit("d", "c", "-5,0,0,1,0,0,0");
    const Outcome deep = row.run("check");
    INFO(deep.out);
    CHECK(deep.code == 1);
    CHECK(fit_says(deep.out, "'a' and 'b' lie in each other with "));
    CHECK_FALSE(fit_says(deep.out, "'b' and 'c'"));
    CHECK_FALSE(fit_says(deep.out, "none lies in another"));
    const json told = json::parse(row.run("check", "--json").out);
    CHECK(told["ok"] == false);
    CHECK(told["problems"].size() == 1);
    REQUIRE(row.run("hide", "a").code == 0);
    CHECK(row.run("check").code == 0);
}

TEST_CASE("a fit to the healthy side is refused where the plan has none") {
    const Row row;
    for (const char* verb : {"snap", "settle", "assemble"}) {
        CAPTURE(verb);
        row.fit("b", "a", "-1,0,0,1,0,0,0");
        const Outcome refused = row.run(verb, std::string(verb) == "snap" ? "b a --healthy" : "--healthy");
        CHECK(refused.code == 2);
        CHECK(fit_says(refused.err, "the plan has no healthy side: lay it on a fragment with 'tactus plan mirror'"));
    }
}

TEST_CASE("a gap between fragments that do not face each other is not told as a number", "[slow]") {
    const Row row;
    REQUIRE(row.run("move", "b --pose 0,0,90,1,0,0,0").code == 0);
    const Outcome gap = row.run("gap", "a b");
    INFO(gap.out);
    CHECK(fit_says(gap.out, "a, b"));
    CHECK_FALSE(fit_says(gap.out, "median gap"));
    const json pair = json::parse(row.run("gap", "a b --json").out)["pairs"][0];
    CHECK(pair["gap_median_mm"].is_null());
    CHECK(pair["gap_p95_mm"].is_null());
    CHECK(json::parse(row.run("gap", "c d --json").out)["pairs"][0]["gap_median_mm"].get<double>() ==
          Approx(1.0).margin(0.1));
}

TEST_CASE("a fragment deep inside of another is told by its overlap, though no surfaces face each other", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    folder.write("large.stl", test::box_stl(Vec3(0.0, 0.0, 0.0), Vec3(24.0, 24.0, 24.0)));
    folder.write("small.stl", test::box_stl(Vec3(5.0, 5.0, 5.0), Vec3(19.0, 19.0, 19.0)));
    const std::string plan = file("case.plan.json");
    REQUIRE(folder.tactus("plan new " + plan + " " + file("large.stl") + " " + file("small.stl")).code == 0);
    const Outcome gap = folder.tactus("plan gap " + plan);
    INFO(gap.out << gap.err);
    CHECK(fit_says(gap.out, "overlap, mm³"));
    CHECK(fit_says(gap.out, "large, small"));
    CHECK_FALSE(fit_says(gap.out, "no two shown fragments"));
    // The small one's points are deep in the large one; those of the large one are nowhere in the small one.
    const json pair = json::parse(folder.tactus("plan gap " + plan + " --json").out)["pairs"][0];
    CHECK(pair["deepest_mm"].get<double>() > 4.0);
    CHECK(pair["overlap_mm3"].get<double>() == Approx(2744.0).epsilon(0.02));
    CHECK(folder.tactus("plan check " + plan).code == 1);
}

TEST_CASE("a healthy side that does not lie on the fragment leaves the plan as it was", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(test::bar(), file("bar.vdb"));
    folder.write("a.stl", test::box_stl(Vec3(30.0, 0.0, 0.0), Vec3(40.0, 12.0, 14.0)));
    folder.write("other.stl", test::box_stl(Vec3(0.0, 0.0, 0.0), Vec3(60.0, 60.0, 60.0)));
    const std::string plan = file("case.plan.json");
    REQUIRE(folder.tactus("plan new " + plan + " " + file("bar.vdb") + " " + file("a.stl")).code == 0);
    const std::string box = test::box_stl(Vec3(0.0, 0.0, 0.0), Vec3(60.0, 60.0, 60.0)), end = "endfacet\n";
    folder.write("open.stl", box.substr(0, box.find(end, box.size() / 2) + end.size()) + "endsolid\n");
    folder.write("triangle.stl", box.substr(0, box.find(end) + end.size()) + "endsolid\n");
    const std::string before = slurp(plan);
    for (const char* const wrong : {"other.stl", "open.stl", "triangle.stl"}) {
        const std::string call = "plan mirror " + plan + " " + file(wrong) + " bar a --settle";
        const Outcome refused = folder.tactus(call);
        INFO(wrong << ": " << refused.out << refused.err);
        CHECK(refused.code == 1);
        CHECK(fit_says(refused.out, "problem: the mirrored side lies more than 2 mm away from half of 'bar'"));
        CHECK(fit_says(refused.out, "the plan is unchanged"));
        CHECK(json::parse(folder.tactus(call + " --json").out)["others"].empty());
        CHECK(slurp(plan) == before);
    }
    REQUIRE(folder.tactus("plan mirror " + plan + " " + file("bar.vdb") + " bar").code == 0);
    // The report says which file the step laid, and how well.
    REQUIRE(folder.tactus("plan report " + plan).code == 0);
    const std::string page = slurp(folder.path / "case.html");
    CHECK(fit_says(page, "bar.vdb, "));
    CHECK(fit_says(page, " mm median residual</td>"));
}

TEST_CASE("a plan of which nothing is shown is not finished", "[slow]") {
    const Row row;
    REQUIRE(row.run("hide", "a b c d").code == 0);
    const Outcome check = row.run("check");
    INFO(check.out);
    CHECK(check.code == 1);
    CHECK(fit_says(check.out, "no fragment is shown; show some with 'tactus plan unhide'"));
    CHECK(row.run("assemble").code == 2);
}

TEST_CASE("a pose too far away for a body is refused, and the plan is as it was", "[slow]") {
    const Row row;
    const std::string before = slurp(row.plan);
    for (const char* pose : {"1e308,0,0,1,0,0,0", "0,-1e9,0,1,0,0,0", "0,0,1e5.1,1,0,0,0"}) {
        const Outcome moved = row.run("move", std::string("b --pose ") + pose);
        INFO(pose << moved.err);
        CHECK(moved.code == 2);
        CHECK(std::ranges::count(moved.err, '\n') == 1);
    }
    CHECK(fit_says(row.run("move", "b --pose 1e308,0,0,1,0,0,0").err, "100 m away"));
    CHECK(slurp(row.plan) == before);
}

TEST_CASE("a fragment does not go where a third one is, is told why it stays, and keeps to what stands", "[long]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(test::bar(), file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 5 --turn 10").code ==
            0);
    // It takes up the bar's right end.
    folder.write("third.stl", test::box_stl(Vec3(10.0, -5.0, -8.0), Vec3(18.0, 5.0, 8.0)));
    const std::string plan = file("case.plan.json");
    REQUIRE(folder
                .tactus("plan new " + plan + " one=" + file("f/fragment_01.vdb") + " two=" + file("f/fragment_02.vdb") +
                        " third=" + file("third.stl"))
                .code == 0);
    const Outcome blocked = folder.tactus("plan snap " + plan + " two one");
    INFO(blocked.out << blocked.err);
    CHECK(blocked.code == 1);
    CHECK(fit_says(blocked.out, "blocked\n"));
    CHECK(fit_says(blocked.out, "it would lie in 'third' with"));
    REQUIRE(folder.tactus("plan hide " + plan + " third").code == 0);
    // Nothing fits from too far away, and no distance is told.
    REQUIRE(folder.tactus("plan move " + plan + " two --pose 60,0,0,1,0,0,0").code == 0);
    const Outcome far = folder.tactus("plan snap " + plan + " two one");
    INFO(far.out);
    CHECK(far.code == 1);
    CHECK(fit_says(far.out, "too far away"));
    CHECK(fit_says(far.out, "--mode global"));
    const json told = json::parse(folder.tactus("plan snap " + plan + " two one --json").out);
    CHECK(told["rms_mm"].is_null());
    CHECK(told["moved"].is_null());
    CHECK(fit_says(told["reason"].get<std::string>(), "too far away"));
    REQUIRE(folder.tactus("plan undo " + plan).code == 0);
    const Outcome fits = folder.tactus("plan snap " + plan + " two");
    INFO(fits.out);
    CHECK(fits.code == 0);
    CHECK(folder.tactus("plan settle " + plan).code == 0);
    // The third one is shown again, and hangs on nothing.
    REQUIRE(folder.tactus("plan unhide " + plan + " third").code == 0);
    REQUIRE(folder.tactus("plan move " + plan + " third --pose 60,0,0,1,0,0,0").code == 0);
    CHECK(folder.tactus("plan check " + plan).code == 1);
    const Outcome settled = folder.tactus("plan settle " + plan);
    INFO(settled.out);
    CHECK(settled.code == 1);
    CHECK(fit_says(settled.out, "connected to nothing: third"));
}

TEST_CASE("a pair of fragments has the same gap from plan gap, in either order, and from plan mirror", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(test::bar(), file("bar.vdb"));
    REQUIRE(
        folder.tactus("fracture " + file("bar.vdb") + " -o " + file("f") + " --seed 4 --spread 0.2 --turn 1").code ==
        0);
    // Meshes: of the main one only a part is looked at.
    const std::string plan = file("case.plan.json");
    REQUIRE(
        folder.tactus("plan new " + plan + " one=" + file("f/fragment_01.stl") + " two=" + file("f/fragment_02.stl"))
            .code == 0);
    const json there = json::parse(folder.tactus("plan gap " + plan + " one two --json").out)["pairs"][0],
               back = json::parse(folder.tactus("plan gap " + plan + " two one --json").out)["pairs"][0],
               laid = json::parse(folder.tactus("plan mirror " + plan + " " + file("bar.vdb") + " one two --json").out);
    const json& faces = laid["others"][0]["faces"]["before"];
    INFO(there << back << faces);
    CHECK(there["contact_mm2"].get<double>() > 20.0);
    for (const char* number : {"facing_mm2", "contact_mm2", "gap_median_mm", "gap_p95_mm", "deepest_mm"})
        CHECK(back[number].get<double>() == Approx(there[number].get<double>()));
    CHECK(faces["contact_mm2"].get<double>() == Approx(there["contact_mm2"].get<double>()).epsilon(0.02));
    CHECK(faces["gap_median_mm"].get<double>() == Approx(there["gap_median_mm"].get<double>()).margin(0.01));
    CHECK(faces["deepest_mm"].get<double>() == Approx(there["deepest_mm"].get<double>()).margin(0.05));
}

TEST_CASE("check loads no fragment that cannot lie in another, and none of which it knows the answer", "[slow]") {
    const Row row;
    // Deep in each other; the third and the fourth are far away, and not to be read as bones any more.
    REQUIRE(row.run("move", "b --pose -4,0,0,1,0,0,0").code == 0);
    REQUIRE(row.run("hide", "d").code == 0);
    json file = json::parse(slurp(row.plan));
    row.folder.write("d.stl", "no mesh");
    Hash hash;
    file::add_file(hash, row.folder.path / "d.stl");
    file["fragments"][3]["hash"] = fmt::format("{:016x}", hash.value());
    row.folder.write("case.plan.json", file.dump());
    const auto problems = [&] { return json::parse(row.run("check", "--json").out)["problems"]; };
    const json first = problems();
    INFO(first);
    CHECK(fit_says(first.dump(), "'a' and 'b' lie in each other with "));
    // Bones, points and boxes of the fragments, and one file per pair whose boxes meet.
    const auto kept = [&] {
        std::map<std::string, std::string> all;
        for (const auto& entry : std::filesystem::directory_iterator(row.folder.path / ".cache/tactus/results"))
            all[entry.path().filename()] = slurp(entry.path());
        return all;
    };
    const auto once = kept();
    CHECK(once.size() == 12);
    CHECK(problems() == first);
    CHECK(kept() == once);
    // At another place the answer is another one, also when both move together.
    REQUIRE(row.run("move", "b --pose -2,0,0,1,0,0,0").code == 0);
    const json second = problems();
    CHECK(second != first);
    CHECK(fit_says(second.dump(), "'a' and 'b' lie in each other with "));
    REQUIRE(row.run("undo").code == 0);
    CHECK(problems() == first);
    REQUIRE(row.run("move", "b --pose 0,0,0,1,0,0,0").code == 0);
    CHECK_FALSE(fit_says(problems().dump(), "lie in each other"));
    CHECK(kept().size() == once.size());
}

TEST_CASE("the report of a trauma case is a PDF file too, with all of the page", "[slow]") {
    const Row row;
    row.fit("b", "a", "-1,0,0,1,0,0,0");
    row.fit("c", "b", "-2,0,0,1,0,0,0");
    REQUIRE(row.run("move", "b --pose -1,3,0,1,0,0,0").code == 0);
    const std::string pdf = (row.folder.path / "case.pdf").string();
    const Outcome made = row.run("report", fmt::format("-o {} -o {}", pdf, (row.folder.path / "case.html").string()));
    INFO(made.err);
    REQUIRE(made.code == 0);
    CHECK(fit_says(made.out, "case.pdf"));
    CHECK(fit_says(slurp(row.folder.path / "case.html"), "<h2 class=\"fail\">Warnings"));
    std::optional<std::string> text = test::pdf_text(row.folder, pdf);
    if (!text) return;
    std::ranges::replace(*text, '\f', '\n');  // a page may begin with a heading
    // Warnings first; then fits, pictures with sides, scale and names, gaps, poses, steps.
    std::size_t last = 0;
    for (const char* heading :
         {"Warnings", "Fragments", "Pictures", "Gaps and overlaps", "Poses", "Order of steps", "Alternatives"}) {
        CAPTURE(heading);
        const std::size_t at = text->find(std::string("\n") + heading + "\n", last);
        CHECK(at != std::string::npos);
        last = std::min(at, text->size());
    }
    for (const char* written : {" R ", " L", " S", " mm", "fit to a is void", "parts that no fit connects"}) {
        CAPTURE(written);
        CHECK(fit_says(*text, written));
    }
}

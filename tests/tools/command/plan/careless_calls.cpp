// SPDX-License-Identifier: Apache-2.0
// Careless calls of the verbs of a plan: one error that says what to do, exit code 2, and every file as it was.
#include "tests/support/catch.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>

using namespace tactus;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;

namespace {

/// A plan of two boxes.
struct TwoBoxes {
    Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();

    TwoBoxes() {
        folder.write("a.stl", box_stl(Vec3(0.0), Vec3(10.0, 12.0, 14.0)));
        folder.write("b.stl", box_stl(Vec3(11.0, 0.0, 0.0), Vec3(20.0, 12.0, 14.0)));
        REQUIRE(folder.tactus("plan new " + plan + " " + file("a.stl") + " " + file("b.stl")).code == 0);
    }
    std::string file(const std::string& name) const { return (folder.path / name).string(); }
    void is_refused(const std::string& arguments, const std::string& because) const {
        CAPTURE(arguments);
        const Outcome refused = folder.tactus(arguments);
        CAPTURE(refused.out, refused.err);
        CHECK(refused.code == 2);
        CHECK_THAT(refused.err, ContainsSubstring(because));
        CHECK(std::ranges::count(refused.err, '\n') <= 2);
    }
};

}  // namespace

TEST_CASE("a report is never written over its plan, over a bone of it, or over itself") {
    const TwoBoxes boxes;
    const std::string before = slurp(boxes.plan), bone = slurp(boxes.folder.path / "a.stl");
    const std::string report = "plan report " + boxes.plan;
    boxes.is_refused(report + " -o " + boxes.plan, "this is a source");
    boxes.is_refused(report + " --pdf " + boxes.plan, "this is a source");
    boxes.is_refused(report + " -o " + boxes.file("a.stl"), "this is a source");
    boxes.is_refused(report + " -o " + boxes.file("x.html") + " --pdf " + boxes.file("x.html"), "two results");
    // Nothing is written when one of two results cannot be.
    boxes.is_refused(report + " --pdf " + boxes.file("nowhere/x.pdf"), "there is no folder");
    CHECK(slurp(boxes.plan) == before);
    CHECK(slurp(boxes.folder.path / "a.stl") == bone);
    CHECK(!fs::exists(boxes.folder.path / "case.html"));
    CHECK(!fs::exists(boxes.folder.path / "x.html"));
}

TEST_CASE("an option with a range takes no 'nan'") {
    const TwoBoxes boxes;
    const std::string before = slurp(boxes.plan);
    boxes.is_refused("plan snap " + boxes.plan + " a b --kerf nan", "'nan' is not a number");
    boxes.is_refused("plan assemble " + boxes.plan + " --kerf NaN", "'NaN' is not a number");
    CHECK(slurp(boxes.plan) == before);
}

TEST_CASE("a fragment is not fitted to itself and does not face itself") {
    const TwoBoxes boxes;
    boxes.is_refused("snap " + boxes.file("a.stl") + " " + boxes.file("./a.stl"), "cannot be fitted to itself");
    boxes.is_refused(
        "fracture-surface " + boxes.file("a.stl") + " --facing " + boxes.file("a.stl") + " -o " + boxes.file("o.json"),
        "cannot face itself");
}

TEST_CASE("a healthy side in metres that states no unit is refused, and one that states it is read in it") {
    const TwoBoxes boxes;
    const std::string before = slurp(boxes.plan), small = box_stl(Vec3(0.0), Vec3(0.010, 0.012, 0.014));
    boxes.folder.write("metres.stl", small);
    boxes.is_refused("plan mirror " + boxes.plan + " " + boxes.file("metres.stl") + " a", "states no unit");
    CHECK(slurp(boxes.plan) == before);
    boxes.folder.write("said.stl", "solid unit=m" + small.substr(small.find('\n')));
    boxes.folder.write("mm.stl", box_stl(Vec3(0.0), Vec3(10.0, 12.0, 14.0)));
    const auto median = [&](const std::string& file) {
        const Outcome laid = boxes.folder.tactus("plan mirror " + boxes.plan + " " + boxes.file(file) + " a");
        return laid.out.substr(0, laid.out.find('\n'));
    };
    CHECK_THAT(median("said.stl"), ContainsSubstring("mirrored side on a"));
    CHECK(median("said.stl") == median("mm.stl"));
}

TEST_CASE("no result is written over what its verb reads, and nothing changes when a result cannot be written") {
    const TwoBoxes boxes;
    const std::string before = slurp(boxes.plan), bone = slurp(boxes.folder.path / "a.stl");
    for (const char* name : {"inputs.json", "defect.mrk.json"}) boxes.folder.write(name, "{}");
    const std::vector<std::string> of_plan{
        "show",  "check",  "gap",  "snap", "settle", "assemble", "mirror", "cuts", "cuts --from-pieces",
        "reach", "paddle", "guide"};
    const auto call = [&](const std::string& verb) {
        const std::string more = verb == "snap"     ? " a b"
                                 : verb == "mirror" ? " " + boxes.file("b.stl") + " a"
                                 : verb == "paddle" ? " --defect " + boxes.file("defect.mrk.json")
                                                    : "";
        return "plan " + verb + " " + boxes.plan + more + " -o ";
    };
    for (const std::string& verb : of_plan) {
        boxes.is_refused(call(verb) + boxes.plan, "this is a source");
        boxes.is_refused(call(verb) + boxes.file("a.stl"), "this is a source");
        boxes.is_refused(call(verb) + boxes.file("nowhere/x.json"), "there is no folder");
    }
    boxes.is_refused(call("mirror") + boxes.file("b.stl"), "this is a source");
    boxes.is_refused(call("paddle") + boxes.file("defect.mrk.json"), "this is a source");
    boxes.is_refused("plan fibula " + boxes.file("inputs.json") + " -o " + boxes.file("inputs.json"),
                     "this is a source");
    const std::string two = boxes.file("a.stl") + " " + boxes.file("b.stl") + " -o " + boxes.file("a.stl");
    for (const char* verb : {"register ", "snap "}) boxes.is_refused(verb + two, "this is a source");
    for (const char* verb : {"info ", "vessel --seed 0,0,0 "})
        boxes.is_refused(verb + boxes.file("a.stl") + " -o " + boxes.file("a.stl"), "this is a source");
    CHECK(slurp(boxes.plan) == before);
    CHECK(slurp(boxes.folder.path / "a.stl") == bone);
    CHECK(slurp(boxes.folder.path / "inputs.json") == "{}");
}

TEST_CASE("a fragment that cannot be moved is named") {
    const TwoBoxes boxes;
    REQUIRE(boxes.folder.tactus("plan lock " + boxes.plan + " a").code == 0);
    boxes.is_refused("plan move " + boxes.plan + " a --pose 1,0,0,1,0,0,0", "'a' cannot be moved: ");
}

TEST_CASE("plan reach --take writes no measures, and a report no values") {
    const TwoBoxes boxes;
    boxes.is_refused("plan reach " + boxes.plan + " --take 1 -o " + boxes.file("x.json"), "give -o without it");
    boxes.is_refused("plan report " + boxes.plan + " -o " + boxes.file("x.json"), "is written as .html, .pdf or .txt");
    boxes.is_refused("plan guide " + boxes.plan, "--out is required");
    CHECK(!fs::exists(boxes.file("x.json")));
}

TEST_CASE("plan report --pdf, an old spelling, writes the page beside the plan too", "[slow]") {
    const TwoBoxes boxes;
    const Outcome made = boxes.folder.tactus("plan report " + boxes.plan + " --json --pdf " + boxes.file("x.pdf"));
    INFO(made.err);
    CHECK(made.code == 0);
    CHECK(fs::exists(boxes.file("case.html")));
    CHECK(fs::exists(boxes.file("x.pdf")));
    CHECK_THAT(made.out, ContainsSubstring("\"version\": 1"));
    const std::string page = slurp(boxes.file("case.html"));
    const auto first = page.find("Gaps and overlaps");
    if (first != std::string::npos) CHECK(page.find("Gaps and overlaps", first + 1) == std::string::npos);
    CHECK_THAT(page, ContainsSubstring("there are no steps"));
}

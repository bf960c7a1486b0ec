// SPDX-License-Identifier: Apache-2.0
// The verbs of a plan that change and measure a flap.
#include "assets/transform/transform_file.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/slicer_markups.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/pdf_text.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>

using namespace tactus;
using nlohmann::json;
namespace fs = std::filesystem;
using Catch::Matchers::ContainsSubstring;

namespace {

// A case with vessels, perforators and sites in files as other programs write them.
struct FlapCase : test::JawCase {
    FlapCase() {
        std::string table = "branch,x_mm,y_mm,z_mm,radius_mm,contrast,confidence,parent\n", curve;
        for (int z = -190; z <= 100; z += 5) {
            table += "0,100,10," + std::to_string(z) + ",1.4,1,1," + std::to_string(z) + "\n";
            curve += (curve.empty() ? "" : ",") + std::string("{\"label\":\"c\",\"position\":[-103,-10,") +
                     std::to_string(z) + "]}";
        }
        table += "1,0,0,0,1,1,1,3\n1,0,5,0,1,1,1,3\n";
        folder.write("artery.csv", table);
        folder.write("vein.mrk.json",
                     R"({"markups":[{"type":"Curve","coordinateSystem":"RAS","controlPoints":[)" + curve + "]}]}");
        folder.write("sites.mrk.json",
                     R"({"markups":[{"type":"Fiducial","coordinateSystem":"LPS","coordinateUnits":"mm",
                         "controlPoints":[{"label":"facial artery","position":[45,20,-30]},
                                          {"label":"facial vein","position":[48,20,-30]}]}]})");
    }
    json whole() const {
        json all = inputs();
        all["vessels"] = {{{"kind", "artery"}, {"file", "artery.csv"}},
                          {{"name", "comitant"}, {"kind", "vein"}, {"file", "vein.mrk.json"}}};
        all["sites"] = "sites.mrk.json";
        all["perforators"] = {{{"name", "middle"}, {"at_mm", {100, 12, -100}}}};
        all["margin_mm"] = 12;
        return all;
    }
    json shown() const { return json::parse(folder.tactus("plan show " + plan + " --json").out)["reconstruction"]; }
    test::Outcome change(const std::string& verb, const std::string& arguments) const {
        return folder.tactus("plan " + verb + " " + plan + " " + arguments);
    }
    json reach(const std::string& more = "") const {
        return json::parse(folder.tactus("plan reach " + plan + " --json" + more).out);
    }
};

}  // namespace

TEST_CASE(
    "a plan takes vessels, sites and marks from files, and each change of the flap is a step that undo takes back",
    "[slow]") {
    const FlapCase made;
    const test::Outcome done = made.run(made.whole());
    INFO(done.err);
    REQUIRE(done.code == 0);
    json now = made.shown();
    REQUIRE(now["vessels"].size() == 2);
    CHECK(now["vessels"][0]["name"] == "artery");
    CHECK(now["vessels"][0]["radius_mm"].get<double>() == Approx(1.4));
    CHECK(now["vessels"][0]["length_mm"].get<double>() == Approx(290.0));
    CHECK(now["vessels"][1]["length_mm"].get<double>() == Approx(290.0));
    CHECK(now["sites"][1]["kind"] == "vein");
    CHECK(now["margin_mm"].get<double>() == Approx(12.0));

    CHECK(made.change("plate", "front --screws 3").code == 0);
    CHECK(made.change("implant", "molar --at 0 -41 6 --axis 0 0 -1").code == 0);
    CHECK(made.change("site", "'lingual artery' --at 30 0 -40").code == 0);
    CHECK(made.change("site", "low --at 100 12 -110 --perforator").code == 0);
    CHECK(made.change("vessel", "second --kind vein --file " + (made.folder.path / "artery.csv").string()).code == 0);
    CHECK(made.change("margin", "--margin 5").code == 0);
    // Of a file with several marks the one that is named.
    const std::string marks = (made.folder.path / "sites.mrk.json").string();
    CHECK(made.change("site", "'facial vein' --remove").code == 0);
    CHECK(made.change("site", "'facial artery' --remove").code == 0);
    CHECK(made.change("site", "'facial vein' --file " + marks).code == 0);
    CHECK(made.shown()["sites"].size() == 2);
    const test::Outcome unknown = made.change("site", "'facial nerve' --file " + marks);
    CHECK(unknown.code == 2);
    CHECK_THAT(unknown.err, ContainsSubstring("has no mark 'facial nerve'"));
    for (int n = 0; n < 3; ++n) CHECK(made.change("undo", "").code == 0);
    now = made.shown();
    // Two segments of three screws, and three on each of two stumps.
    CHECK(now["plates"][0]["screws"] == 12);
    CHECK(now["implants"][0]["length_mm"].get<double>() == Approx(14.0));
    CHECK(now["sites"].size() == 3);
    CHECK(now["perforators"].size() == 2);
    CHECK(now["vessels"].size() == 3);
    CHECK(now["margin_mm"].get<double>() == Approx(5.0));
    for (int n = 0; n < 6; ++n) CHECK(made.change("undo", "").code == 0);
    now = made.shown();
    CHECK(now["plates"].empty());
    CHECK(now["sites"].size() == 2);
    CHECK(now["margin_mm"].get<double>() == Approx(12.0));
    CHECK(made.change("redo", "--steps 6").code == 0);
    CHECK(made.change("implant", "molar --remove").code == 0);
    CHECK(made.shown()["implants"].empty());

    // What cannot be is refused, and the plan stays.
    const std::string before = test::slurp(made.plan);
    CHECK_THAT(made.change("implant", "molar --remove").err, ContainsSubstring("no implant 'molar'"));
    CHECK(made.change("implant", "x --at 0 0 0 --axis 0 0 0").code == 2);
    CHECK(made.change("site", "nerve --at 0 0 0").code == 2);
    CHECK(made.change("vessel", "third --kind vein --file none.csv").code == 2);
    CHECK(made.change("margin", "none.stl").code == 2);
    CHECK(test::slurp(made.plan) == before);
}

TEST_CASE("plan reach tells what the vessels do, and ranks eight candidates", "[slow]") {
    const FlapCase made;
    REQUIRE(made.run(made.whole()).code == 0);
    const json found = made.reach(" --rank");
    REQUIRE(found["reaches"].size() == 2);
    CHECK(test::broken_schema(made.folder, "plan-reach", found) == "");
    CHECK(test::broken_schema(made.folder, "plan-show",
                              json::parse(made.folder.tactus("plan show " + made.plan + " --json").out)) == "");
    const json& artery = found["reaches"][0];
    CHECK(artery["site"] == "facial artery");
    CHECK(artery["free_mm"].get<double>() == Approx(0.89 * artery["in_situ_mm"].get<double>()));
    CHECK(artery["path_settled"] == true);
    CHECK(artery["tension_n"].is_number());
    CHECK(found["reaches"][1]["tension_n"].is_null());
    CHECK(found["spans"].size() == 2);
    REQUIRE(found["candidates"].size() == 8);
    CHECK(std::ranges::count_if(found["candidates"], [](const json& c) { return c["as_given"] == true; }) == 1);
    // While a segment lies in the leg, vessels are measured as planned.
    REQUIRE(made.folder.tactus("plan undo " + made.plan).code == 0);
    const json in_leg = made.reach();
    CHECK(in_leg["reaches"] == found["reaches"]);
    CHECK(std::ranges::count_if(in_leg["warnings"], [](const json& w) { return w["code"] == "not-placed"; }) == 1);
    // A plan without a reconstruction is refused.
    for (int n = 0; n < 3; ++n) REQUIRE(made.folder.tactus("plan undo " + made.plan).code == 0);
    CHECK_THAT(made.folder.tactus("plan reach " + made.plan).err, ContainsSubstring("no reconstruction"));
}

TEST_CASE("a piece of jaw that has another file since is measured in that file", "[slow]") {
    const FlapCase made;
    REQUIRE(made.run(made.whole()).code == 0);
    const fs::path before = made.folder.path / "case-pieces/jaw-1.stl", after = made.folder.path / "painted.stl";
    REQUIRE(fs::exists(before));
    const json found = made.reach();
    fs::copy_file(before, after);
    REQUIRE(made.change("repaint", "jaw-1 " + after.string()).code == 0);
    fs::remove(before);
    CHECK(made.reach()["reaches"] == found["reaches"]);
    fs::remove(after);
    CHECK(made.change("reach", "").code == 2);
}

TEST_CASE("thresholds of a flap are parameters of the plan, and a warning follows them", "[slow]") {
    const FlapCase made;
    json given = made.whole();
    given["limits"] = {{"kink_radii", 0.0}, {"twist_deg", 180}, {"over_in_situ", 1.0}};
    REQUIRE(made.run(given).code == 0);
    REQUIRE(made.change("implant", "molar --at -8 -41 6 --axis 0 0 -1").code == 0);
    const auto near_cut = [&] {
        const json found = made.reach();
        return std::ranges::count_if(found["warnings"], [](const json& w) { return w["code"] == "near-cut"; });
    };
    // The implant is 5.93 mm away from a cut.
    REQUIRE(made.change("limits", "--clearance 5.9").code == 0);
    CHECK(near_cut() == 0);
    REQUIRE(made.change("limits", "--clearance 6").code == 0);
    CHECK(near_cut() == 1);
    const json step = json::parse(test::slurp(made.plan))["steps"].back()["reconstruction"]["limits"];
    CHECK(step["clearance_m"].get<double>() == Approx(0.006));
    CHECK(step["kink_radii"] == 0.0);
    CHECK(step["twist_rad"].get<double>() == Approx(3.14159265));
    CHECK(made.change("limits", "").code == 2);
    CHECK(made.change("limits", "--twist 200").code == 2);
    given["limits"] = {{"clearance_mm", -1}};
    CHECK_THAT(
        made.folder.tactus("plan reconstruct other.json " + made.folder.write("bad.json", given.dump()).string()).err,
        ContainsSubstring("negative 'clearance'"));
}

// Costly: a reconstruction is planned and written by several commands.
TEST_CASE("a candidate of the ranking becomes an alternative of the plan in one command", "[slow]") {
    const FlapCase made;
    REQUIRE(made.run(made.whole()).code == 0);
    const json ranked = made.reach(" --rank")["candidates"];
    int given = 0, mirrored = 0, excluded = 0;
    for (int n = 1; n <= 8; ++n) {
        const json& c = ranked[static_cast<std::size_t>(n - 1)];
        if (!c["excluded"].is_null()) excluded = n;
        else if (c["mirrored"] == true && mirrored == 0) mirrored = n;
        else if (c["mirrored"] == false && c["as_given"] == false && given == 0) given = n;
    }
    const std::string before = test::slurp(made.plan);
    if (excluded > 0) {
        CHECK_THAT(made.change("reach", "--take " + std::to_string(excluded)).err, ContainsSubstring("cannot be"));
        CHECK(test::slurp(made.plan) == before);
    }
    REQUIRE(given + mirrored > 0);
    for (const int number : {given, mirrored}) {
        if (number == 0) continue;
        REQUIRE(made.folder.tactus("plan alternative " + made.plan + " main").code == 0);
        const std::string name = number == given ? "candidate-" + std::to_string(number) : "other-leg";
        const test::Outcome taken = made.change(
            "reach", "--take " + std::to_string(number) + (number == given ? "" : " --alternative other-leg"));
        INFO(taken.err);
        REQUIRE(taken.code == 0);
        const json& wanted = ranked[static_cast<std::size_t>(number - 1)];
        const json now = made.shown(), found = made.reach();
        CHECK(now["leg"] == wanted["leg"]);
        CHECK(now["reversed"] == wanted["reversed"]);
        CHECK(now["roll_deg"].get<double>() == Approx(wanted["roll_deg"].get<double>()));
        // What the ranking said of it holds for the pieces.
        REQUIRE(found["reaches"].size() == wanted["reaches"].size());
        for (std::size_t n = 0; n < found["reaches"].size(); ++n)
            CHECK(found["reaches"][n]["path_mm"].get<double>() ==
                  Approx(wanted["reaches"][n]["path_mm"].get<double>()).margin(0.3));
        CHECK(made.change("reach", "--take " + std::to_string(number) + " --alternative " + name).code == 2);
    }
    CHECK(made.change("reach", "--take 9").code == 2);
    CHECK(made.change("reach", "--alternative x").code == 2);
}

// Costly: a reconstruction is planned and written by several commands.
TEST_CASE("a second reconstruction of a plan is an alternative with its own pieces, and the report shows both",
          "[slow]") {
    const FlapCase made;
    REQUIRE(made.run(made.whole()).code == 0);
    json other = made.whole();
    other["reversed"] = true;
    const std::string file = made.folder.write("other.json", other.dump()).string();
    const test::Outcome added =
        made.folder.tactus("plan reconstruct " + made.plan + " " + file + " --alternative reversed");
    INFO(added.err);
    REQUIRE(added.code == 0);
    CHECK(fs::exists(made.folder.path / "case-reversed-pieces" / "segment-2.stl"));
    const auto hidden = [&](const std::string& name) {
        const json plan = json::parse(made.folder.tactus("plan show " + made.plan + " --json").out);
        for (const json& f : plan["fragments"])
            if (f["name"] == name) return f["hidden"].get<bool>();
        return false;
    };
    CHECK(made.shown()["reversed"] == true);
    CHECK((hidden("segment-1") && !hidden("segment-1-reversed") && hidden("resected-reversed")));
    REQUIRE(made.folder.tactus("plan alternative " + made.plan + " main").code == 0);
    CHECK(made.shown()["reversed"] == false);
    CHECK((!hidden("segment-1") && hidden("segment-1-reversed") && hidden("resected")));
    CHECK(made.folder.tactus("plan reconstruct " + made.plan + " " + file + " --alternative reversed").code == 2);

    // For 3D Slicer: the planes map to each other by the transforms that are exported.
    REQUIRE(made.folder.tactus("plan export " + made.plan + " -o " + (made.folder.path / "out").string()).code == 0);
    for (const char* name : {"segment-1.stl", "segment-1.tfm", "fibula-cut-1-2.mrk.json", "jaw-plane-2.mrk.json",
                             "vessel-artery-on-bone.mrk.json", "vessel-artery-pedicle.mrk.json", "sites.mrk.json",
                             "vessel-artery-pedicle.stl", "vessel-comitant-on-bone.vtp", "vessel-comitant-in-leg.vtp"})
        CHECK(fs::exists(made.folder.path / "out" / name));
    // In the leg a vessel has the length of its table.
    const json in_leg = json::parse(test::slurp(made.folder.path / "out" / "vessel-artery-in-leg.mrk.json"));
    CHECK(in_leg["markups"][0]["controlPoints"].size() > 2);
    const json cut = json::parse(test::slurp(made.folder.path / "out" / "jaw-plane-2.mrk.json"))["markups"][0];
    CHECK(cut["type"] == "Plane");
    CHECK(cut["coordinateSystem"] == "LPS");
    const json origin = made.inputs()["mandible_planes"][1]["origin"];
    for (std::size_t axis = 0; axis < 3; ++axis)
        CHECK(cut["center"][axis].get<double>() == Approx(origin[axis].get<double>()).margin(1e-9));

    const fs::path page = made.folder.path / "case.html", pdf = made.folder.path / "case.pdf";
    const test::Outcome reported =
        made.folder.tactus(fmt::format("plan report {} -o {} -o {}", made.plan, page.string(), pdf.string()));
    if (reported.err.find("OpenGL") != std::string::npos) return;
    INFO(reported.err);
    REQUIRE(reported.code == 0);
    const std::string html = test::slurp(page);
    for (const char* words : {"Osteotomies of the fibula", "Order of the operation", "Candidates, best first",
                              "Alternatives side by side", "Alternative 'reversed'"})
        CHECK_THAT(html, ContainsSubstring(words));
    CHECK_THAT(html, ContainsSubstring("Segment 2, cut at plane 3 of the jaw"));
    if (const std::optional<std::string> text = test::pdf_text(made.folder, pdf))
        CHECK_THAT(*text,
                   ContainsSubstring("Osteotomies of the fibula") && ContainsSubstring("Alternatives side by side"));
}

TEST_CASE("every exported markup and transform opens by the rules of 3D Slicer with the numbers of the plan",
          "[slow]") {
    const FlapCase made;
    REQUIRE(made.run(made.whole()).code == 0);
    REQUIRE(made.change("plate", "front --screws 1").code == 0);
    REQUIRE(made.change("implant", "molar --at 0 -41 6 --axis 0 0 -1").code == 0);
    const fs::path out = made.folder.path / "out";
    REQUIRE(made.folder.tactus("plan export " + made.plan + " -o " + out.string()).code == 0);
    std::map<std::string, test::SlicerMarkup> opened;
    for (const fs::directory_entry& entry : fs::directory_iterator(out)) {
        const std::string name = entry.path().filename().string(), text = test::slurp(entry.path());
        INFO(name);
        if (name.ends_with(".mrk.json")) opened[name] = test::read_as_slicer(text).front();
        if (name.ends_with(".tfm")) CHECK_NOTHROW(transform::motion_of_text(text, name));
    }
    std::map<std::string, int> kinds;
    for (const auto& [name, markup] : opened) ++kinds[markup.type];
    CHECK(kinds["Plane"] == 7);  // three of the jaw, two per segment
    CHECK((kinds["Curve"] > 4 && kinds["Line"] > 3 && kinds["Fiducial"] > 3));
    // A cut in the donor and the transform of its segment give the plane of the jaw; Slicer has it in RAS.
    const Pose placed = transform::read_motion(out / "segment-1.tfm");
    const auto lps = [](const Vec3& v) { return Vec3(-v.x, -v.y, v.z); };
    const test::SlicerMarkup &cut = opened.at("fibula-cut-1-1.mrk.json"), &jaw = opened.at("jaw-plane-1.mrk.json");
    CHECK(glm::length(placed.apply(lps(cut.origin) * mm) - lps(jaw.origin) * mm) < 1e-9);
    CHECK(std::abs(glm::dot(placed.rotate(lps(cut.normal)), lps(jaw.normal))) == Approx(1.0));
    const json given = made.inputs()["mandible_planes"][0];
    for (int axis = 0; axis < 3; ++axis)
        CHECK(lps(jaw.origin)[axis] ==
              Approx(given["origin"][static_cast<std::size_t>(axis)].get<double>()).margin(1e-9));
    CHECK(std::abs(glm::dot(lps(jaw.normal), glm::normalize(Vec3(0.717, -0.697, 0.0)))) == Approx(1.0));
    CHECK(opened.at("sites.mrk.json").labels == std::vector<std::string>{"facial artery", "facial vein"});
    // The transform that was exported places a segment again.
    const auto pose = [&] {
        const json shown = json::parse(made.folder.tactus("plan show " + made.plan + " --json").out);
        for (const json& one : shown["fragments"])
            if (one["name"] == "segment-1") return one["pose"];
        return json();
    };
    const json before = pose();
    REQUIRE(made.change("move", "segment-1 --pose 0,0,0,1,0,0,0").code == 0);
    CHECK(pose() != before);
    REQUIRE(made.change("move", "segment-1 --transform " + (out / "segment-1.tfm").string()).code == 0);
    for (const char* key : {"position_mm", "quaternion_wxyz"})
        for (std::size_t n = 0; n < before[key].size(); ++n)
            CHECK(pose()[key][n].get<double>() == Approx(before[key][n].get<double>()).margin(1e-9));
    CHECK_THAT(made.change("move", "segment-1").err, ContainsSubstring("a place is needed: --pose or --transform"));
}

TEST_CASE("exported meshes and lines, read by VTK, have the size, the volume and the radius of the plan", "[slow]") {
    if (std::system("/usr/bin/python3 -c 'import vtk' 2>/dev/null") != 0) return test::skip("no python3-vtk9 here");
    const FlapCase made;
    REQUIRE(made.run(made.whole()).code == 0);
    std::vector<fs::path> files;
    for (const char* format : {"stl", "ply"}) {
        const fs::path out = made.folder.path / format;
        REQUIRE(made.folder.tactus("plan export " + made.plan + " --format " + format + " -o " + out.string()).code ==
                0);
        for (const fs::directory_entry& entry : fs::directory_iterator(out))
            if (const auto type = entry.path().extension(); type == ".stl" || type == ".ply" || type == ".vtp")
                files.push_back(entry.path());
    }
    std::string command =
        "/usr/bin/python3 " + (test::source_folder() / "tests/tools/command/reconstruction/read_by_vtk.py").string();
    for (const fs::path& file : files) command += " '" + file.string() + "'";
    const fs::path printed = made.folder.path / "vtk.txt";
    REQUIRE(std::system((command + " >" + printed.string()).c_str()) == 0);
    std::istringstream lines(test::slurp(printed));
    int meshes = 0, courses = 0;
    for (std::string line; std::getline(lines, line);) {
        const json found = json::parse(line);
        const fs::path file = found["name"].get<std::string>();
        INFO(file.string());
        if (file.extension() == ".vtp") {
            ++courses;
            CHECK(found["lines"] == 1);
            CHECK(found["points"].get<int>() >= 2);
            const double radius = file.filename().string().find("artery") != std::string::npos ? 1.4 : 1.5;
            CHECK(found["arrays"]["radius_mm"][0].get<double>() == Approx(radius));
            CHECK(found["arrays"]["radius_mm"][1].get<double>() == Approx(radius));
            continue;
        }
        ++meshes;
        const mesh::Mesh own = mesh::load_mesh(file);
        CHECK(found["triangles"] == own.triangles.size());
        CHECK(found["points"] == own.vertices.size());
        CHECK(found["volume"].get<double>() == Approx(mesh::volume_of(own)).epsilon(1e-4));
        for (int axis = 0; axis < 3; ++axis) {
            double low = 1e9, high = -1e9;
            for (const Vec3& v : own.vertices) low = std::min(low, v[axis]), high = std::max(high, v[axis]);
            CHECK(found["bounds"][static_cast<std::size_t>(2 * axis)].get<double>() == Approx(low).margin(1e-4));
            CHECK(found["bounds"][static_cast<std::size_t>(2 * axis + 1)].get<double>() == Approx(high).margin(1e-4));
        }
    }
    CHECK((meshes > 10 && courses > 4));
}

TEST_CASE("an undefined control point is no site, and the command names it", "[slow]") {
    const FlapCase made;
    made.folder.write("sites.mrk.json",
                      R"({"markups":[{"type":"Fiducial","controlPoints":[
                          {"label":"facial artery, left","position":[37,8,-24],"positionStatus":"defined"},
                          {"label":"facial vein, undefined","position":[0,0,0],"positionStatus":"undefined"}]}]})");
    const test::Outcome done = made.run(made.whole());
    CHECK(done.code == 0);
    CHECK_THAT(done.err,
               ContainsSubstring("note: ") && ContainsSubstring("control point 2 ('facial vein, undefined') has no "
                                                                "position (its status is \"undefined\"): left out"));
    CHECK(made.shown()["sites"].size() == 1);
    const auto old = made.folder.write("old.fcsv",
                                       "# Markups fiducial file version = 4.10\n# CoordinateSystem = 0\n"
                                       "1,-48,-20,-30,0,0,0,1,1,1,0,facial vein,,\n");
    CHECK(made.change("site", "--file " + old.string()).code == 0);
    CHECK(made.shown()["sites"][1]["name"] == "facial vein");
}

TEST_CASE("a vessel that was followed in a scan becomes a pedicle of the flap, or a site on it", "[slow]") {
    const FlapCase made;
    const test::Folder& folder = made.folder;
    // 100 mm along x, of the neck; its branch 1 leaves it downwards.
    const auto neck = folder.write("neck.csv",
                                   "branch,x_mm,y_mm,z_mm,radius_mm\n0,0,0,0,2\n0,60,0,0,2\n0,100,0,0,2\n"
                                   "1,60,0,0,1\n1,60,0,-20,1\n");
    // It is in the plan before there is a reconstruction.
    folder.write("bone.obj", "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    REQUIRE(folder.tactus("plan new " + made.plan + " " + (folder.path / "bone.obj").string()).code == 0);
    REQUIRE(made.change("vessel", "carotid --kind artery --file " + neck.string()).code == 0);
    const fs::path out = folder.path / "scan-out";
    REQUIRE(folder.tactus("plan export " + made.plan + " -o " + out.string()).code == 0);
    for (const char* type : {".stl", ".vtp", ".mrk.json"})
        CHECK(fs::exists(out / ("vessel-carotid" + std::string(type))));
    CHECK_THAT(test::slurp(out / "vessel-carotid.vtp"), ContainsSubstring("100.000000 0.000000 0.000000"));
    // A vessel that was taken away again leaves no empty entry.
    REQUIRE(made.change("vessel", "carotid --remove").code == 0);
    const test::Outcome bare = folder.tactus("plan export " + made.plan + " --json -o " + (out / "bare").string());
    CHECK(json::parse(bare.out)["written"].size() == 1);
    REQUIRE(made.change("vessel", "carotid --kind artery --file " + neck.string()).code == 0);

    const std::string inputs = folder.write("inputs.json", made.whole().dump()).string();
    REQUIRE(folder.tactus("plan reconstruct " + made.plan + " " + inputs + " --alternative flap").code == 0);
    const auto site = [&](const std::string& name) {
        const json shown = made.shown();
        for (const json& one : shown["sites"])
            if (one["name"] == name) return one;
        return json();
    };
    REQUIRE(made.change("site", "high --of-scan carotid --along 75").code == 0);
    CHECK(site("high")["at_mm"] == json{75.0, 0.0, 0.0});
    CHECK(site("high")["kind"] == "artery");
    REQUIRE(made.change("site", "'end of the vein' --file " + neck.string() + " --branch 1").code == 0);
    CHECK(site("end of the vein")["at_mm"] == json{60.0, 0.0, -20.0});
    CHECK(site("end of the vein")["kind"] == "vein");
    REQUIRE(made.change("vessel", "second --of-scan carotid").code == 0);
    REQUIRE(made.change("vessel", "third --kind vein --branch 1 --file " + neck.string()).code == 0);
    int found = 0;
    const json shown = made.shown();
    for (const json& one : shown["vessels"]) {
        if (one["name"] == "second") found += one["kind"] == "artery" && one["radius_mm"] == 2.0;
        if (one["name"] == "third") found += one["kind"] == "vein" && one["radius_mm"] == 1.0;
    }
    CHECK(found == 2);

    const std::string before = test::slurp(made.plan);
    for (const auto& [verb, words, why] :
         {std::array{"site", "high --of-scan carotid --along 101", "100.0 mm long, less than 101.0 mm"},
          {"site", "high --of-scan jugular", "has no vessel 'jugular'; it has: carotid"},
          {"site", "high --at 1 2 3 --along 5", "--along is a way on a vessel"},
          {"site", "high --at 1 2 3 --of-scan carotid", "needs a place"},
          {"vessel", "second --of-scan jugular", "has no vessel 'jugular'"},
          {"vessel", "second --of-scan carotid --branch 1", "--branch is of a file"},
          {"vessel", "second --file neck.mrk.json --of-scan carotid", "a vessel needs --file"}}) {
        CAPTURE(words);
        const test::Outcome refused = made.change(verb, words);
        CHECK(refused.code == 2);
        CHECK_THAT(refused.err, ContainsSubstring(why));
    }
    CHECK(made.change("vessel", "second --branch 7 --file " + neck.string()).code == 2);
    CHECK(test::slurp(made.plan) == before);
}

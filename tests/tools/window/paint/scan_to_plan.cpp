// SPDX-License-Identifier: Apache-2.0
// From a DICOM folder to a plan with fragments and a vessel, and its report: by commands, and in the window.
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/window/eyes.hpp"
#include "tests/tools/window/on_display.hpp"
#include "tests/tools/window/person.hpp"

#include <algorithm>
#include <cmath>
#include <future>

using namespace tactus;
using namespace tactus::test;
using nlohmann::json;

namespace {

/// A CT with voxels of 1 x 1 x 2 mm: a plate of bone in two halves that touch over a part of their faces, an artery of radius
/// 3 mm in front of it.
void write_raw_scan(const std::filesystem::path& folder) {
    WrittenVolume scan;
    scan.size = {80, 60, 40};
    scan.step[2].z = 2.0;
    scan.origin = {-40.0, 100.0, -300.0};
    scan.fill([](const Vec3& p) {
        const Vec3 at = p - Vec3(-40.0, 100.0, -300.0);
        const double noise = 12.0 * std::sin(12.9898 * at.x + 78.233 * at.y + 37.719 * at.z);
        const bool is_plate = at.x >= 5 && at.x < 75 && at.z >= 6 && at.z < 74 && at.y >= 20 && at.y < 32;
        const bool is_gap = at.x >= 40 && at.x < 42;
        const bool is_bridge = std::hypot(at.y - 26.0, at.z - 40.0) < 4.0;
        const double edge = std::hypot(at.x - 40.0, at.y - 46.0) - 3.0;
        if (is_plate && (!is_gap || is_bridge)) return noise + (is_gap ? 620.0 : 800.0);
        if (at.y < 4.0) return noise - 1000.0;
        return noise + 40.0 + 360.0 * std::clamp(0.5 - edge, 0.0, 1.0);
    });
    std::filesystem::create_directory(folder);
    write_dicom_folder(scan, folder);
}

constexpr const char* seeds = R"({"labels": [
    {"name": "left", "strokes": [{"radius_mm": 4, "points_mm": [[-20, 126, -260], [-20, 126, -240]]}]},
    {"name": "right", "strokes": [{"radius_mm": 4, "points_mm": [[20, 126, -260]]}]}]})";

void check_vessel(const json& plan, const std::string& name) {
    REQUIRE(plan["vessels"].size() == 1);
    CHECK(plan["vessels"][0]["name"] == name);
    CHECK(plan["vessels"][0]["kind"] == "artery");
    CHECK(plan["vessels"][0]["length_mm"].get<double>() == Approx(78.0).margin(8.0));
    CHECK(plan["vessels"][0]["radius_mm"].get<double>() == Approx(3.0).margin(0.4));
}

}  // namespace

// Costly: the whole way from a scan to a report.
TEST_CASE("commands lead from a DICOM folder to a plan of fragments and a vessel, and its report shows both",
          "[slow]") {
    const Folder folder;
    write_raw_scan(folder.path / "ct");
    folder.write("seeds.json", seeds);
    const auto at = [&](const char* name) { return (folder.path / name).string(); };
    const auto done = [&](const std::string& arguments) {
        const Outcome outcome = folder.tactus(arguments);
        INFO(arguments << "\n" << outcome.err);
        REQUIRE(outcome.code == 0);
        return outcome.out;
    };
    done("segment " + at("ct") + " --threshold 500 --seeds " + at("seeds.json") + " -o " + at("labels.seg.nrrd") +
         " -o " + at("case.vdb") + " --plan " + at("case.plan.json"));
    done("vessel " + at("ct") + " --seed=0,146,-260 -o " + at("artery.csv"));
    const std::string plan = " " + at("case.plan.json");
    done("plan vessel" + plan + " artery --file " + at("artery.csv"));
    json shown = json::parse(done("plan show" + plan + " --json"));
    REQUIRE(shown["fragments"].size() == 2);
    CHECK(shown["fragments"][1]["name"] == "right");
    check_vessel(shown, "artery");
    CHECK(done("plan show" + plan).find("artery  artery  ") != std::string::npos);

    done("plan report" + plan);
    std::string page = slurp(folder.path / "case.html");
    CHECK(page.find("<h2>Vessels</h2>") != std::string::npos);
    // 14.5 mm from the axis to the plate, and a wall of 3 mm.
    CHECK(page.find("reaches") == std::string::npos);
    const std::size_t row = page.find(" artery</td><td>artery</td>");
    REQUIRE(row != std::string::npos);
    const std::string cells = page.substr(row, page.find("</tr>", row) - row);
    CHECK(cells.find("<td class=\"n\">11.") != std::string::npos);
    // A fragment that is moved into the vessel.
    done("plan move" + plan + " right --pose=-10,12,0,1,0,0,0");
    done("plan report" + plan);
    page = slurp(folder.path / "case.html");
    CHECK(page.find("into the vessel") != std::string::npos);

    // Undo takes the vessel away, redo brings it, and --remove is a step.
    done("plan undo" + plan);
    done("plan undo" + plan);
    CHECK(json::parse(done("plan show" + plan + " --json"))["vessels"].empty());
    done("plan redo" + plan);
    check_vessel(json::parse(done("plan show" + plan + " --json")), "artery");
    done("plan vessel" + plan + " artery --remove");
    CHECK(json::parse(done("plan show" + plan + " --json"))["vessels"].empty());

    const std::string before = slurp(folder.path / "case.plan.json");
    const std::vector<std::string> wrong{"other --remove", "artery --file " + at("none.csv"),
                                         "line --file " + at("artery.csv"), "artery --file " + at("seeds.json"),
                                         "artery"};
    for (const std::string& bad : wrong) {
        const Outcome refused = folder.tactus("plan vessel" + plan + " " + bad);
        CAPTURE(bad, refused.err);
        CHECK(refused.code == 2);
        CHECK(std::ranges::count(refused.err, '\n') == 1);
    }
    CHECK(slurp(folder.path / "case.plan.json") == before);
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("the window leads from a DICOM folder to a plan of fragments and a vessel", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    write_raw_scan(folder.path / "ct");
    folder.write("script", R"(size 1000 700
label "fragment 1"
brush 4
stroke -20 126 -260  -20 126 -240
label "fragment 2"
stroke 20 126 -260
rename "fragment 1" left
rename "fragment 2" right
vessel 0 146 -260
until solved
plan
until solved
close
)");
    const Outcome done = on(display, folder, "segment ct --threshold 500 --paint case.seeds.json --view-script script");
    INFO(done.err << done.out);
    REQUIRE(done.code == 0);
    const auto plan = [&](const char* name) {
        const Outcome shown = on(display, folder, fmt::format("plan show {} --json", name));
        REQUIRE(shown.code == 0);
        return json::parse(shown.out);
    };
    CHECK(plan("case.plan.json")["fragments"].size() == 2);
    check_vessel(plan("case.plan.json"), "case-vessel-1");
    REQUIRE(on(display, folder, "plan report case.plan.json").code == 0);
    CHECK(slurp(folder.path / "case.html").find("case-vessel-1") != std::string::npos);

    // The next session has the vessel of the one before, and can leave it out.
    folder.write("again", "until solved\nplan\nuntil solved\npress \"vessel 1\"\nplan\nuntil solved\nclose\n");
    const Outcome again = on(display, folder, "segment ct --threshold 500 --paint case.seeds.json --view-script again");
    INFO(again.err << again.out);
    REQUIRE(again.code == 0);
    check_vessel(plan("case-2.plan.json"), "case-vessel-1");
    CHECK(plan("case-3.plan.json")["vessels"].empty());
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a person leads from a DICOM folder to a plan with mouse and keyboard", "[display]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    write_raw_scan(folder.path / "ct");
    folder.write("script", watching_script("", 25.0));
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder, "segment ct --threshold 500 --paint case.seeds.json --view-script script");
    });
    REQUIRE(person.sees_window("ct - Tactus", 30.0));
    Person::wait(2.0);
    const Eyes eyes{folder.path};
    const Spot axial = eyes.spot("axial");
    // The slice shows the bone, 70 mm wide, on 92 % of its panel; its middle is that of the bone.
    const double pixels = 0.92 * std::min(axial.right - axial.left, axial.bottom - axial.top) / 70.0;
    const auto click = [&](double x, double y) {
        person.click(0.5 * (axial.left + axial.right) + (x + 0.5) * pixels,
                     0.5 * (axial.top + axial.bottom) + (y - 125.5) * pixels);
        Person::wait(0.4);
    };
    click(-20.0, 126.0);
    person.tap("2");
    click(20.0, 126.0);
    person.tap("v");
    click(0.0, 146.0);
    const auto is_there = [&](const char* name) {
        for (int n = 0; n < 150 && !std::filesystem::exists(folder.path / name); ++n) Person::wait(0.1);
        return std::filesystem::exists(folder.path / name);
    };
    CHECK(is_there("case-vessel-1.mrk.json"));
    Person::wait(0.5);
    press(person, eyes, "Make a plan");
    CHECK(is_there("case.plan.json"));
    keep(person, "scan-to-plan");
    person.chord({"Control_L"}, "q");
    const Outcome outcome = done.get();
    INFO(outcome.err << outcome.out);
    CHECK(outcome.code == 0);
    const Outcome shown = on(display, folder, "plan show case.plan.json --json");
    REQUIRE(shown.code == 0);
    CHECK(json::parse(shown.out)["fragments"].size() == 2);
    check_vessel(json::parse(shown.out), "case-vessel-1");
}

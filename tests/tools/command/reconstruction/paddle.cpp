// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"
#include "tests/tools/json_schema.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

// A reconstruction whose first segment has a perforator, and a defect of 30 by 20 mm in front of the chin.
struct PaddleCase : test::JawCase {
    PaddleCase() {
        json all = inputs();
        all["perforators"] = {{{"name", "middle"}, {"at_mm", {100, 7, -110}}},
                              {{"name", "knee"}, {"at_mm", {100, 7, 100}}}};
        const test::Outcome made = run(all);
        INFO(made.err);
        REQUIRE(made.code == 0);
        curve("near.mrk.json", -55.0);
        curve("far.mrk.json", -160.0);
    }
    void curve(const std::string& name, double y) const {
        json points = json::array();
        for (int n = 0; n < 24; ++n) {
            const double a = 2.0 * std::numbers::pi * n / 24.0;
            points.push_back({{"label", "d"}, {"position", {15.0 * std::cos(a), y, 10.0 * std::sin(a)}}});
        }
        folder.write(name, json{{"markups",
                                 {{{"type", "ClosedCurve"},
                                   {"coordinateSystem", "LPS"},
                                   {"coordinateUnits", "mm"},
                                   {"controlPoints", points}}}}}
                               .dump());
    }
    std::string file(const std::string& name) const { return (folder.path / name).string(); }
    test::Outcome paddle(const std::string& options) const {
        return folder.tactus("plan paddle " + plan + " " + options);
    }
    json shown() const { return json::parse(folder.tactus("plan show " + plan + " --json").out)["reconstruction"]; }
};

}  // namespace

TEST_CASE("a paddle is placed behind the bone at its perforators, is a step that undo takes back, and covers a defect",
          "[slow]") {
    const PaddleCase made;
    const test::Outcome placed = made.paddle("--defect " + made.file("near.mrk.json") + " --thickness 4 -o " +
                                             made.file("paddle.stl") + " --json");
    INFO(placed.err);
    const json found = json::parse(placed.out);
    // The bone has 7 mm of radius; its posterior border is at y = 7 mm.
    CHECK(found["paddle"]["at_mm"][0].get<double>() == Approx(100.0).margin(1e-6));
    CHECK(found["paddle"]["at_mm"][1].get<double>() == Approx(27.0).margin(0.1));
    CHECK(found["paddle"]["at_mm"][2].get<double>() == Approx(-110.0).margin(1e-6));
    CHECK(found["defect_mm2"].get<double>() == Approx(std::numbers::pi * 150.0).epsilon(0.02));
    CHECK(found["coverage"].get<double>() > 0.99);
    CHECK(test::broken_schema(made.folder, "plan-paddle", found) == "");
    REQUIRE(found["perforators"].size() == 1);
    CHECK(found["perforators"][0]["name"] == "middle");
    CHECK(found["unused_perforators"] == json{"knee"});
    CHECK(placed.code == (found["warnings"].empty() ? 0 : 1));
    const double volume = mesh::volume_of(mesh::load_mesh(made.folder.path / "paddle.stl")) * 1e-9;
    CHECK(volume == Approx(found["area_mm2"].get<double>() * 4.0 * 1e-9).epsilon(0.03));
    CHECK(made.shown()["paddle"]["length_mm"] == 60.0);
    CHECK(made.folder.tactus("plan undo " + made.plan).code == 0);
    CHECK(made.shown()["paddle"].is_null());
}

TEST_CASE("a defect that the perforators do not reach is warned of, with the missing length", "[slow]") {
    const PaddleCase made;
    const test::Outcome far = made.paddle("--defect " + made.file("far.mrk.json") + " --json");
    CHECK(far.code == 1);
    const json found = json::parse(far.out);
    CHECK(found["perforators"][0]["slack_mm"].get<double>() < -30.0);
    CHECK(found["warnings"].dump().find("perforator-too-short") != std::string::npos);
    CHECK(found["perforators"][0]["tension_N"].get<double>() > 0.5);
    // A longer perforator reaches.
    const json longer = json::parse(made.paddle("--defect " + made.file("far.mrk.json") + " --rope 200 --json").out);
    CHECK(longer["perforators"][0]["slack_mm"].get<double>() ==
          Approx(found["perforators"][0]["slack_mm"].get<double>() + 150.0).margin(6.0));
}

TEST_CASE("options of a paddle that contradict each other are refused, and the plan stays as it was") {
    const PaddleCase made;
    CHECK(made.paddle("-o " + made.file("paddle.stl")).code == 2);
    CHECK(made.paddle("--remove").code == 2);
    CHECK(made.paddle("--remove --defect " + made.file("near.mrk.json")).code == 2);
    CHECK(made.paddle("--at 100 0 -110").code == 2);
    CHECK_THAT(made.paddle("--at 100 0 -110").err, ContainsSubstring("lies on the donor's line"));
    CHECK(made.shown()["paddle"].is_null());
    CHECK(made.paddle("--at 100 30 -110 --length 50").code == 0);
    CHECK(made.paddle("--remove").code == 0);
    CHECK(made.shown()["paddle"].is_null());
}

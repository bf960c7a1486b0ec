// SPDX-License-Identifier: Apache-2.0
// tactus plan cuts: place by hand first, then derive the osteotomies.
#include "tests/support/catch.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"
#include "tests/tools/json_schema.hpp"

#include <nlohmann/json.hpp>

#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

struct PlacedCase : test::JawCase {
    test::Outcome verb(const std::string& name, const std::string& rest = "") const {
        return folder.tactus("plan " + name + " " + plan + " " + rest);
    }
    json pose_of(const std::string& name) const {
        const json shown = json::parse(verb("show", "--json").out);
        for (const json& one : shown["fragments"])
            if (one["name"] == name) return one["pose"];
        return {};
    }
    /// Moves a segment along the jaw's z axis, mm.
    void lift(const std::string& name, double z) const {
        const json pose = pose_of(name), &p = pose["position_mm"], &q = pose["quaternion_wxyz"];
        std::string text;
        for (const double part : {p[0].get<double>(), p[1].get<double>(), p[2].get<double>() + z, q[0].get<double>(),
                                  q[1].get<double>(), q[2].get<double>(), q[3].get<double>()})
            text += (text.empty() ? "" : ",") + json(part).dump();
        REQUIRE(verb("move", name + " --pose " + text).code == 0);
    }
};

}  // namespace

TEST_CASE("cuts follow pieces that were placed by hand, as an alternative whose pieces are where they were placed",
          "[slow]") {
    const PlacedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    for (const char* name : {"segment-1", "segment-2"}) made.lift(name, 2.0);
    const json placed = made.pose_of("segment-2");
    CHECK_THAT(made.verb("show").out, ContainsSubstring("segment-2 lies 2.00 mm and 0.00° from its planned place"));
    const test::Outcome done = made.verb("cuts", "--from-pieces --json");
    INFO(done.out << done.err);
    REQUIRE(done.code == 0);
    const json cuts = json::parse(done.out);
    CHECK(test::broken_schema(made.folder, "plan-cuts", cuts) == "");
    CHECK(cuts["alternative"] == "from-pieces");
    for (const json& segment : cuts["segments"]) {
        CHECK(segment["from_placed_mm"].get<double>() < 1e-6);
        CHECK(segment["from_placed_deg"].get<double>() < 1e-6);
        CHECK(segment["length_mm"].get<double>() == Approx(segment["length_before_mm"].get<double>()).margin(1e-6));
    }
    CHECK_THAT(made.verb("show").out, !ContainsSubstring("from its planned place"));
    const json now = made.pose_of("segment-2-from-pieces");
    for (std::size_t axis = 0; axis < 3; ++axis)
        CHECK(now["position_mm"][axis].get<double>() == Approx(placed["position_mm"][axis].get<double>()).margin(1e-6));
    CHECK(std::filesystem::exists(made.folder.path / "case-from-pieces-pieces/segment-2.stl"));
    CHECK_THAT(made.verb("cuts", "--from-pieces").err, ContainsSubstring("'from-pieces' exists already"));
}

TEST_CASE("the cuts of a plan are those of the inputs that it was made of", "[slow]") {
    const PlacedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    const std::string inputs = (made.folder.path / "inputs.json").string();
    const test::Outcome listed = made.verb("cuts", "--json");
    INFO(listed.err);
    REQUIRE(listed.code == 0);
    const json cuts = json::parse(listed.out);
    CHECK(test::broken_schema(made.folder, "plan-fibula", cuts) == "");
    CHECK(cuts == json::parse(made.folder.tactus("plan fibula " + inputs + " --json").out));
    // The planes of the donor, placed, are those of the jaw.
    const json &segment = cuts["segments"][0], &m = segment["donor_to_target"],
               &p = segment["donor_planes"][0]["origin_mm"];
    for (std::size_t row = 0; row < 3; ++row) {
        double sum = m[row][3].get<double>();
        for (std::size_t column = 0; column < 3; ++column)
            sum += m[row][column].get<double>() * p[column].get<double>();
        CHECK(sum == Approx(test::at(0.8)[row].get<double>()).margin(1e-6));
    }
    CHECK_THAT(made.verb("cuts").out, ContainsSubstring("segment 1, at plane 1 of the jaw"));
}

TEST_CASE("cuts of pieces are refused with the next step where they are not defined", "[slow]") {
    const PlacedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    REQUIRE(made.verb("move", "jaw-1 --pose 1,0,0,1,0,0,0").code == 0);
    CHECK_THAT(made.verb("cuts", "--from-pieces").err, ContainsSubstring("'jaw-1' was moved"));
    REQUIRE(made.verb("undo", "--steps 2").code == 0);
    CHECK_THAT(made.verb("cuts", "--from-pieces").err, ContainsSubstring("'segment-2' is still in the leg"));
}

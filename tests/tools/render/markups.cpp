// SPDX-License-Identifier: Apache-2.0
#include "tools/render/markups.hpp"

#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

using namespace tactus;
using namespace tactus::render;

TEST_CASE("lengths and angles become markups of Slicer in millimetres") {
    const std::vector<Measurement> all{{"width", {Vec3(0.0), Vec3(0.012, 0.0, 0.0)}},
                                       {"corner", {Vec3(0.01, 0.0, 0.0), Vec3(0.0), Vec3(0.0, 0.02, 0.0)}},
                                       {"one point", {Vec3(0.0)}}};
    CHECK(measurement_words(all[0]) == "12.00 mm");
    CHECK(measurement_words(all[1]) == "10.00 mm, 20.00 mm, 90.0°");
    CHECK(measurement_words(all[2]).empty());
    const nlohmann::json file = nlohmann::json::parse(markups_text(all));
    REQUIRE(file["markups"].size() == 2);
    CHECK(file["markups"][0]["type"] == "Line");
    CHECK(file["markups"][0]["coordinateSystem"] == "LPS");
    CHECK(file["markups"][0]["controlPoints"][1]["position"][0] == 12.0);
    CHECK(file["markups"][1]["type"] == "Angle");
    CHECK(file["markups"][1]["controlPoints"].size() == 3);
    CHECK(file["markups"][1]["controlPoints"][2]["position"][1] == 20.0);
}

// SPDX-License-Identifier: Apache-2.0
#include "assets/markup/markup.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/slicer_markups.hpp"

#include <glm/geometric.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using markup::Kind;
using markup::Markup;

namespace {

Vec3 in_ras_mm(const Vec3& p) { return {-p.x / mm, -p.y / mm, p.z / mm}; }

markup::ReadPoints points_in(const std::string& points) {
    return markup::points_of_text(
        R"({"@schema": "x", "markups": [{"type": "Fiducial", "controlPoints": [)" + points + "]}]}", "sites.mrk.json");
}

std::string refusal_of_marks(const std::string& text, bool is_fcsv = false) {
    try {
        if (is_fcsv) markup::points_of_fcsv(text, "f.fcsv");
        else markup::points_of_text(text, "f.mrk.json");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a plane in any direction opens by Slicer's rules with its origin, normal and size") {
    std::uint64_t count = 0;
    const auto between = [&](double low, double high) { return low + (high - low) * Random{7}.uniform(++count); };
    std::vector<Vec3> normals{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    for (int n = 0; n < 200; ++n)
        normals.push_back(glm::normalize(Vec3(between(-1, 1), between(-1, 1), between(-1, 1))));
    for (const Vec3& normal : normals) {
        Markup plane;
        plane.kind = Kind::plane;
        plane.name = "jaw-plane-1";
        plane.normal = normal;
        plane.side = 30 * mm;
        plane.points = {{"jaw-plane-1", Vec3(between(-0.2, 0.2), between(-0.2, 0.2), 0.03), ""}};
        const std::vector<test::SlicerMarkup> opened = test::read_as_slicer(markup::text_of({&plane, 1}));
        REQUIRE(opened.size() == 1);
        CHECK(opened[0].type == "Plane");
        CHECK(opened[0].name == "jaw-plane-1");
        CHECK(glm::length(opened[0].origin - in_ras_mm(plane.points[0].position)) < 1e-9);
        CHECK(glm::length(opened[0].normal - Vec3(-normal.x, -normal.y, normal.z)) < 1e-12);
        CHECK(opened[0].determinant == Approx(1.0));
        CHECK(opened[0].size == std::array<double, 3>{30.0, 30.0, 0.0});
    }
}

TEST_CASE("every kind of markup opens by Slicer's rules with its points, labels and name") {
    std::vector<Markup> all;
    for (const auto& [kind, count] : {std::pair{Kind::fiducial, 4}, std::pair{Kind::line, 2}, std::pair{Kind::angle, 3},
                                      std::pair{Kind::curve, 9}, std::pair{Kind::plane, 1}}) {
        Markup made;
        made.kind = kind;
        made.name = "Zunge, \"links\" ü";
        made.colour = Vec3(0.2, 0.4, 1.0);
        for (int n = 0; n < count; ++n)
            made.points.push_back({"p" + std::to_string(n), Vec3(0.01 * n, -0.02, 0.1 / 3), "radius 1 mm"});
        all.push_back(made);
    }
    const std::string text = markup::text_of(all);
    const std::vector<test::SlicerMarkup> opened = test::read_as_slicer(text);
    REQUIRE(opened.size() == all.size());
    std::size_t at = 0;
    const markup::ReadPoints back = markup::points_of_text(text, "all.mrk.json");
    CHECK(back.notes.empty());
    for (std::size_t n = 0; n < all.size(); ++n) {
        CHECK(opened[n].name == all[n].name);
        REQUIRE(opened[n].points.size() == all[n].points.size());
        for (std::size_t k = 0; k < all[n].points.size(); ++k, ++at) {
            CHECK(glm::length(opened[n].points[k] - in_ras_mm(all[n].points[k].position)) < 1e-9);
            CHECK(opened[n].labels[k] == all[n].points[k].label);
            CHECK(glm::length(back.points[at].position - all[n].points[k].position) < 1e-15);
            CHECK(back.points[at].description == "radius 1 mm");
        }
    }
}

TEST_CASE("a control point without a position is left out and named") {
    const markup::ReadPoints found = points_in(
        R"({"label": "artery", "position": [37, 8, -24], "positionStatus": "defined"},
           {"label": "vein", "position": [0, 0, 0], "positionStatus": "undefined"},
           {"label": "nerve", "position": "", "positionStatus": "undefined"},
           {"position": [1, 2, 3], "positionStatus": "preview"}, {"label": "last", "position": [1, 2, 3]})");
    REQUIRE(found.points.size() == 2);
    CHECK(found.points[0].label == "artery");
    CHECK(glm::length(found.points[0].position - Vec3(37, 8, -24) * mm) < 1e-15);
    CHECK(found.points[1].label == "last");
    CHECK(found.notes ==
          std::vector<std::string>{
              "sites.mrk.json: control point 2 ('vein') has no position (its status is \"undefined\"): left out",
              "sites.mrk.json: control point 3 ('nerve') has no position (its status is \"undefined\"): left out",
              "sites.mrk.json: control point 4 has no position (its status is \"preview\"): left out"});
}

TEST_CASE("the points of each markup of a file are distinguished") {
    markup::Markup first, second;
    first.kind = second.kind = markup::Kind::curve;
    first.points.resize(2);
    second.points.resize(3);
    second.points[0].label = "c";
    const markup::ReadPoints read =
        markup::points_of_text(markup::text_of(std::array{first, markup::Markup{}, second}), "a");
    CHECK(read.points.size() == 5);
    CHECK(markup::points_of_markup(read, 0, "a").size() == 2);
    REQUIRE(markup::points_of_markup(read, 1, "a").size() == 3);
    CHECK(markup::points_of_markup(read, 1, "a")[0].label == "c");
    CHECK_THROWS_WITH(markup::points_of_markup(read, 2, "a.mrk.json"),
                      ContainsSubstring("a.mrk.json: has no curve 2") && ContainsSubstring("2 of its markups"));
}

TEST_CASE("a file of markups in RAS, or with its unit as a code, is read in LPS and metres") {
    const auto points = markup::points_of_text(
        R"({"markups": [{"type": "Curve", "coordinateSystem": "RAS", "coordinateUnits": ["mm", "UCUM", "millimeter"],
                        "controlPoints": [{"label": "a", "position": [1, 2, 3]}]}]})",
        "f.mrk.json");
    REQUIRE(points.points.size() == 1);
    CHECK(glm::length(points.points[0].position - Vec3(-1, -2, 3) * mm) < 1e-15);
}

TEST_CASE("markups that cannot be read safely are refused with the reason") {
    const auto with = [](const std::string& members) {
        return R"({"markups": [{"type": "Fiducial", )" + members + "}]}";
    };
    CHECK_THAT(refusal_of_marks("{}"), ContainsSubstring("has no list 'markups'"));
    CHECK_THAT(refusal_of_marks("[1"), ContainsSubstring("f.mrk.json:1:3: not valid JSON"));
    CHECK_THAT(refusal_of_marks(with(R"("coordinateSystem": "IJK")")), ContainsSubstring("'coordinateSystem' must be"));
    CHECK_THAT(refusal_of_marks(with(R"("coordinateUnits": "um")")), ContainsSubstring("'coordinateUnits' must be"));
    CHECK_THAT(refusal_of_marks(with(R"("controlPoints": [{"label": "a"}])")),
               ContainsSubstring("control point 1 ('a') has no position"));
    CHECK_THAT(refusal_of_marks(with(R"("controlPoints": [{"position": [1, 2]}])")),
               ContainsSubstring("control point 1 has no position"));
    CHECK_THAT(refusal_of_marks(with(R"("controlPoints": [{"position": [1, 2, 3], "positionStatus": "maybe"}])")),
               ContainsSubstring("unknown 'positionStatus'"));
    CHECK_THAT(refusal_of_marks("1,2,3,4,0,0,0,1,1,1,0,a,,\n", true),
               ContainsSubstring("f.fcsv:1:1: the line '# CoordinateSystem"));
    CHECK_THAT(refusal_of_marks("# CoordinateSystem = LPS\n1,2,x,4\n", true),
               ContainsSubstring("f.fcsv:2:1: 'x' is not a coordinate"));
    CHECK_THAT(refusal_of_marks("# CoordinateSystem = LPS\n1,2\n", true), ContainsSubstring("'' is not a coordinate"));
}

TEST_CASE("a point list of older Slicer is read in the frame that it states, with quoted labels") {
    const std::string head = "# Markups fiducial file version = 4.11\r\n# CoordinateSystem = ";
    const std::string rows =
        "\r\n# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\r\n"
        "1,37.5,-8,-24,0,0,0,1,1,1,0,\"facial artery, \"\"left\"\"\",seen in "
        "CT,\r\n2,1,2,3,0,0,0,1,1,1,0,vein,,\r\n\r\n";
    for (const auto& [frame, sign] :
         {std::pair{"LPS", 1.0}, std::pair{"RAS", -1.0}, std::pair{"1", 1.0}, std::pair{"0", -1.0}}) {
        const markup::ReadPoints found = markup::points_of_fcsv(head + frame + rows, "f.fcsv");
        REQUIRE(found.points.size() == 2);
        CHECK(found.points[0].label == "facial artery, \"left\"");
        CHECK(found.points[0].description == "seen in CT");
        CHECK(glm::length(found.points[0].position - Vec3(sign * 37.5, -sign * 8, -24) * mm) < 1e-15);
        CHECK(found.points[1].label == "vein");
    }
}

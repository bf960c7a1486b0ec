// SPDX-License-Identifier: Apache-2.0
#include "assets/vessel/track_file.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>
#include <sstream>

using namespace tactus;

namespace {

vessel::Track forked() {
    vessel::Track track;
    vessel::Branch trunk, side;
    for (int n = 0; n < 21; ++n) {
        vessel::Node node;
        node.position = Vec3(0.01, -0.02, 0.001 * n);
        node.direction = Vec3(0, 0, 1);
        node.radius = 2e-3, node.contrast = 300.0, node.confidence = 0.9, node.along = 0.001 * n;
        trunk.nodes.push_back(node);
        node.position = Vec3(0.01 + 0.001 * n, -0.02, 0.0083);  // no vertex in common
        node.direction = Vec3(1, 0, 0);
        node.radius = 1e-3;
        side.nodes.push_back(node);
    }
    side.parent = 0, side.parent_node = 8;
    track.branches = {trunk, side};
    return track;
}

std::filesystem::path place(const std::string& name) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("tactus_track_file_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    return folder / name;
}

}  // namespace

TEST_CASE("a vessel that is read from the curves of a track is one of its branches, as that of its table") {
    using Catch::Matchers::ContainsSubstring;
    vessel::write_track(forked(), place("artery.csv"));
    vessel::write_track(forked(), place("artery.mrk.json"));
    for (const int branch : {0, 1}) {
        CAPTURE(branch);
        std::vector<std::string> notes;
        const auto read = [&](const char* name) {
            return reconstruction::read_vessel(place(name), reconstruction::VesselKind::artery, branch, notes);
        };
        const reconstruction::FlapVessel table = read("artery.csv"), curve = read("artery.mrk.json");
        REQUIRE(curve.points.size() == table.points.size());
        for (std::size_t n = 0; n < table.points.size(); ++n)
            CHECK(glm::length(curve.points[n] - table.points[n]) < 1e-6);
        REQUIRE(notes.size() == 1);
        CHECK_THAT(notes.front(), ContainsSubstring("of 2 is the vessel; 1 was left out"));
    }
    std::vector<std::string> notes;
    CHECK_THROWS_WITH(
        reconstruction::read_vessel(place("artery.mrk.json"), reconstruction::VesselKind::artery, 2, notes),
        ContainsSubstring("has no curve 2"));
}

TEST_CASE("a track as CSV has a row per node and names the row before each") {
    vessel::write_track(forked(), place("line.csv"));
    std::istringstream text(file::read_whole_file(place("line.csv")));
    std::string row;
    std::getline(text, row);
    CHECK(row == "branch,x_mm,y_mm,z_mm,radius_mm,contrast,confidence,parent");
    std::vector<std::string> rows;
    while (std::getline(text, row)) rows.push_back(row);
    REQUIRE(rows.size() == 42);
    CHECK(rows[0] == "0,10.0000,-20.0000,0.0000,2.0000,300,0.9000,-1");
    CHECK(rows[1].ends_with(",0"));
    CHECK(rows[21].ends_with(",8"));  // leaves the trunk at its ninth node
    CHECK(rows[22].ends_with(",21"));
}

TEST_CASE("a track as Slicer markups has a curve per branch in LPS") {
    vessel::write_track(forked(), place("line.mrk.json"));
    const file::Json json = file::Json::parse(file::read_whole_file(place("line.mrk.json")));
    REQUIRE(json["markups"].size() == 2);
    const file::Json& curve = json["markups"][1];
    CHECK(curve["type"].as_text() == "Curve");
    CHECK(curve["coordinateSystem"].as_text() == "LPS");
    REQUIRE(curve["controlPoints"].size() == 21);
    CHECK(curve["controlPoints"][20]["position"][0].get<double>() == Approx(30.0));
}

TEST_CASE("a track as VTK counts points and lines") {
    vessel::write_track(forked(), place("line.vtp"));
    const std::string text = file::read_whole_file(place("line.vtp"));
    CHECK(text.find("NumberOfPoints=\"42\"") != std::string::npos);
    CHECK(text.find("NumberOfLines=\"2\"") != std::string::npos);
    CHECK(text.find("\n21 42 \n") != std::string::npos);
}

TEST_CASE("warnings stand in the files that have a place for them") {
    vessel::Track track = forked();
    track.branches[1].stenosis = vessel::Stenosis{7, 0.4e-3, 1e-3, 60.0, 4.0, true};
    track.branches[0].start = track.branches[0].end = track.branches[1].end = vessel::End::border;
    for (const std::size_t n : {4u, 5u, 6u}) track.branches[0].nodes[n].is_lost = true;
    const std::vector<std::string> whole{"the peroneal artery was not found"};
    const auto written = [&](const char* name) {
        vessel::write_track(track, place(name), whole);
        return file::read_whole_file(place(name));
    };
    const file::Json json = file::Json::parse(written("warned.mrk.json"));
    const auto text = [&](std::size_t curve, std::size_t point) {
        return json["markups"][curve]["controlPoints"][point]["description"].as_text();
    };
    CHECK(text(0, 0) == "radius 2.000 mm; warning: the peroneal artery was not found");
    CHECK(text(0, 4) ==
          "radius 2.000 mm, without contrast; warning: branch 0 has no contrast from 4.0 to 6.0 mm along it, which is "
          "bridged: it may be closed there, or be another vessel");
    CHECK(text(0, 5) == "radius 2.000 mm, without contrast");
    CHECK(text(1, 7) ==
          "radius 1.000 mm; warning: branch 1 is narrowed by 60 ± 4 % against 1.00 mm at 17.0, -20.0, 8.3, uncertain");
    CHECK(text(1, 8) == "radius 1.000 mm");
    const std::string vtp = written("warned.vtp");
    CHECK(vtp.find("Name=\"warnings\" NumberOfTuples=\"3\"") != std::string::npos);
    CHECK(vtp.find("\n116 104 101 32 112 ") != std::string::npos);  // "the p"
    CHECK(written("warned.csv").find("warning") == std::string::npos);
}

TEST_CASE("tubes of a track are closed and look outwards") {
    vessel::write_track(forked(), place("tubes.stl"));
    const mesh::Mesh tubes = mesh::load_mesh(place("tubes.stl"), 1e-3);
    const mesh::MeshTopology topology = mesh::topology_of(tubes);
    CHECK(topology.is_watertight());
    CHECK(topology.components == 2);
    // A ring of sixteen sides holds 97.4 % of its circle.
    const double circles = std::numbers::pi * (4e-6 * 0.02 + 1e-6 * 0.02);
    CHECK(mesh::volume_of(tubes) == Approx(0.974 * circles).epsilon(0.01));
}

TEST_CASE("a track without branches, or for another extension, is not written") {
    CHECK_THROWS_AS(vessel::write_track({}, place("none.csv")), Error);
    CHECK_THROWS_AS(vessel::write_track(forked(), place("line.txt")), Error);
}

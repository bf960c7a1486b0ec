// SPDX-License-Identifier: Apache-2.0
// The course of a vessel, read from a table as it is written.
#include "assets/vessel/course_file.hpp"

#include "assets/library/flap_case.hpp"
#include "assets/vessel/track_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <unistd.h>

#include <filesystem>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("a course is the main branch of a track that was written, to its last digit") {
    vessel::Track track;
    for (const double side : {0.0, 5e-3}) {
        vessel::Branch branch;
        for (int n = 0; n < 4; ++n) {
            vessel::Node node;
            node.position = Vec3(side, 0.0012345e-3, n * 2e-3);
            node.radius = (1.5 + 0.1 * n) * 1e-3;
            branch.nodes.push_back(node);
        }
        if (side > 0.0) branch.parent = 0, branch.parent_node = 1;
        track.branches.push_back(branch);
    }
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("course_" + std::to_string(::getpid()) + ".csv");
    vessel::write_track(track, path);
    const vessel::Course course = vessel::load_course(path);
    std::filesystem::remove(path);
    REQUIRE(course.points.size() == 4);
    for (std::size_t n = 0; n < 4; ++n)
        CHECK(glm::length(course.points[n] - track.branches[0].nodes[n].position) < 0.5e-7);
    CHECK(course.median_radius() == Approx(1.7e-3));
}

TEST_CASE("a course that is none is refused with its line") {
    const std::string head = "branch,x_mm,y_mm,z_mm,radius_mm,contrast,confidence,parent\n";
    const auto read = [&](const std::string& rows) { return vessel::read_course(head + rows, "a.csv"); };
    CHECK(read("0,0,0,0,1.5,0,1,-1\n0,0,0,2,1.5,0,1,0\n").points.size() == 2);
    CHECK_THROWS_WITH(read("0,0,0,0,1.5,0,1,-1\n0,nan,0,2,1.5,0,1,0\n"), ContainsSubstring("a.csv:3"));
    CHECK_THROWS_WITH(read("0,0,0,0,1.5,0,1,-1\n0,1e9,0,2,1.5,0,1,0\n"), ContainsSubstring("a.csv:3: no place"));
    CHECK_THROWS_WITH(read("0,0,0,0,-1,0,1,-1\n0,0,0,2,1.5,0,1,0\n"), ContainsSubstring("a.csv:2: radius_mm"));
    // Closed at one place is a course; of no radius at all is none.
    CHECK(read("0,0,0,0,1.5,0,1,-1\n0,0,0,2,0,0,1,0\n0,0,0,4,1.5,0,1,0\n").points.size() == 3);
    CHECK_THROWS_WITH(read("0,0,0,0,0,0,1,-1\n0,0,0,2,0,0,1,0\n"), ContainsSubstring("median radius_mm"));
    CHECK_THROWS_WITH(read("0,0,0,0,1.5,0,1,-1\n1,0,0,2,1.5,0,1,0\n"), ContainsSubstring("fewer than two points"));
    CHECK_THROWS_WITH(read("0,0,0,0,1.5,0,1,-1\n0,0,0,0,1.5,0,1,0\n"), ContainsSubstring("fewer than two points"));
    CHECK_THROWS_AS(vessel::read_course("x,y\n1,2\n", "a.csv"), Error);
}

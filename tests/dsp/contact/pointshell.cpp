// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell.hpp"

#include "dsp/core/error.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/support/catch.hpp"

#include <limits>
#include <numeric>
#include <set>
#include <tuple>

using namespace tactus;

namespace {

using Place = std::tuple<double, double, double>;
Place place(const Vec3& p) { return {p.x, p.y, p.z}; }

}  // namespace

TEST_CASE("a pointshell keeps every point, in an order where neighbours stand together") {
    auto points = contact::spread_over_ball(5000, 0.02);
    points[7].label = contact::surface_label::fracture;
    const contact::Pointshell shell = contact::make_pointshell(points);
    REQUIRE(shell.size() == 5000);
    std::set<Place> given, kept;
    for (const auto& p : points) given.insert(place(p.position));
    for (const auto& p : shell.position) kept.insert(place(p));
    CHECK(given == kept);
    double apart = 0.0;
    for (std::size_t i = 1; i < shell.size(); ++i) apart += glm::length(shell.position[i] - shell.position[i - 1]);
    // The spacing is 1 mm; the spiral that was given jumps by 24 mm on average.
    CHECK(apart / 5000.0 < 5e-3);
    for (std::size_t i = 0; i < shell.size(); ++i)
        CHECK((shell.label[i] == contact::surface_label::fracture) == (shell.position[i] == points[7].position));
    CHECK(shell.reach == Approx(0.02));
    CHECK(shell.gyration == Approx(0.02).epsilon(1e-3));
    CHECK(glm::length(shell.centroid) < 1e-5);
}

TEST_CASE("each node of the tree holds what lies below within its radius, nested from coarse to fine") {
    for (const int count : {1, 63, 64, 65, 300, 4096, 10007}) {
        const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(count, 0.02));
        REQUIRE(shell.nodes.size() == shell.chunks.size());
        const double area = std::accumulate(shell.area.begin(), shell.area.end(), 0.0);
        std::size_t leaves = 0;
        for (std::size_t n = 0; n < shell.nodes.size(); ++n) {
            const contact::ShellNode& node = shell.nodes[n];
            double stands_for = 0.0, of_area = 0.0;
            for (std::size_t i = 0; i < contact::chunk_points; ++i) {
                stands_for += static_cast<double>(shell.chunks[n].count[i]);
                of_area += static_cast<double>(shell.chunks[n].area[i]);
                CHECK((i < node.held) == (shell.chunks[n].count[i] > 0.0f));
            }
            CHECK(stands_for == node.points);
            CHECK(of_area == Approx(area * node.points / count).epsilon(1e-4));
            std::set<Place> below;
            bool within = true;
            for (std::uint32_t i = node.first_point; i < node.first_point + node.points; ++i) {
                within = within && glm::length(shell.position[i] - node.centre) <= node.radius * (1.0 + 1e-12);
                below.insert(place(shell.position[i]));
            }
            CHECK(within);
            CHECK(below.contains(place(node.centre)));
            std::uint32_t next = node.first_point;
            for (std::uint32_t c = node.first_child; c < node.first_child + node.children; ++c) {
                CHECK(c > n);
                CHECK(shell.nodes[c].first_point == next);
                next += shell.nodes[c].points;
            }
            if (node.children) CHECK(next == node.first_point + node.points);
            if (!node.children) {
                ++leaves;
                CHECK(node.held == node.points);
            }
        }
        // Chunks are full, as far as that goes.
        CHECK(leaves == static_cast<std::size_t>((count + 63) / 64));
    }
}

TEST_CASE("the same points in any order give the same set of chunks, and the same order the same shell") {
    auto points = contact::spread_over_ball(3000, 0.02);
    const contact::Pointshell a = contact::make_pointshell(points), b = contact::make_pointshell(points);
    CHECK(a.position == b.position);
    std::reverse(points.begin(), points.end());
    const contact::Pointshell c = contact::make_pointshell(points);
    REQUIRE(c.nodes.size() == a.nodes.size());
    for (std::size_t n = 0; n < a.nodes.size(); ++n) {
        CHECK(a.nodes[n].points == c.nodes[n].points);
        CHECK(a.nodes[n].first_point == c.nodes[n].first_point);
    }
}

TEST_CASE("no points make an empty shell, and points that are no numbers are refused") {
    CHECK(contact::make_pointshell({}).empty());
    CHECK(contact::make_pointshell({}).nodes.empty());
    auto points = contact::spread_over_ball(10, 0.02);
    points[3].position.y = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(contact::make_pointshell(points), Error);
    points[3].position.y = 0.0;
    points[4].area = -1.0;
    CHECK_THROWS_AS(contact::make_pointshell(points), Error);
    points[4].area = 1.0;
    points[5].normal = Vec3(0.0);
    CHECK(contact::make_pointshell(points).size() == 10);
    // Many points in one place are still a tree.
    const std::vector<contact::SurfacePoint> same(1000, contact::SurfacePoint{});
    CHECK(contact::make_pointshell(same).size() == 1000);
}

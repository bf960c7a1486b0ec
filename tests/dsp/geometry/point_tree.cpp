// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/point_tree.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <algorithm>
#include <vector>

using namespace tactus;

namespace {

std::vector<Vec3> scattered(std::size_t count, std::uint64_t seed) {
    const Random random{seed};
    std::vector<Vec3> points;
    for (std::uint64_t n = 0; n < count; ++n)
        points.emplace_back(random.uniform(3 * n), random.uniform(3 * n + 1), 0.2 * random.uniform(3 * n + 2));
    return points;
}

}  // namespace

TEST_CASE("geometry: a tree knows whether any point is within a distance") {
    for (const std::size_t count : {0u, 1u, 7u, 9u, 400u}) {
        const std::vector<Vec3> points = scattered(count, 5);
        const geometry::PointTree tree(points);
        for (const Vec3& place : scattered(200, 9))
            for (const double distance : {0.0, 0.03, 0.1, 0.5}) {
                const bool any = std::ranges::any_of(
                    points, [&](const Vec3& p) { return glm::dot(p - place, p - place) < distance * distance; });
                CAPTURE(count, distance);
                REQUIRE(tree.has_nearer(place, distance) == any);
            }
    }
}

TEST_CASE("geometry: a tree takes other points without memory") {
    const std::vector<Vec3> first = scattered(400, 1), second = scattered(300, 2);
    geometry::PointTree tree;
    tree.reserve(400);
    bool is_near = false;
    std::size_t nearest = 0;
    const RealtimeViolations seen = watch([&] {
        tree.assign(first);
        tree.assign(second);
        is_near = tree.has_nearer(second[17], 1e-9);
        nearest = tree.nearest(second[17]);
    });
    CHECK(seen.describe() == "none");
    CHECK(is_near);
    CHECK(nearest == 17);
}

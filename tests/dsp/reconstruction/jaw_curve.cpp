// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/jaw_curve.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/rope/measure.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using namespace tactus::reconstruction;

TEST_CASE("a jaw of straight pieces is split at its corners within 1 mm and 2 degrees whatever the start") {
    int found = 0, worse = 0;
    for (std::uint64_t trial = 0; trial < 100; ++trial) {
        const Random random{trial + 1};
        std::uint64_t draw = 0;
        // Two to four segments of 22 to 45 mm that turn by 25° to 60°, and 0.15 mm of roughness.
        const std::size_t segments = 2 + trial % 3;
        std::vector<Vec3> corners{Vec3(0.0)};
        double heading = 0.0;
        for (std::size_t n = 0; n < segments; ++n) {
            const double length = 22.0 + 23.0 * random.uniform(draw), rise = 0.3 * (random.uniform(draw + 1) - 0.5);
            corners.push_back(corners.back() + mm * length * Vec3(std::cos(heading), std::sin(heading), rise));
            heading += (25.0 + 35.0 * random.uniform(draw + 2)) * degree;
            draw += 3;
        }
        std::vector<Vec3> curve = rope::resampled(corners, 150);
        for (Vec3& p : curve)
            p += 0.15 * mm * Vec3(random.normal(draw), random.normal(draw + 1), random.normal(draw + 2)), draw += 3;
        const CurveSplit best = split_curve(curve, segments, 15.0 * mm);
        REQUIRE(best.joints.size() == segments + 1);
        bool is_near = true;
        for (std::size_t n = 0; n < segments; ++n) {
            is_near = is_near && glm::length(best.joints[n] - corners[n]) < 1.0 * mm;
            const Vec3 a = best.joints[n + 1] - best.joints[n], b = corners[n + 1] - corners[n];
            is_near = is_near && std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) < 2.0 * degree;
        }
        found += is_near;
        // No start is better.
        const double whole = rope::length_of(curve);
        for (int start = 0; start < 100; ++start) {
            std::vector<double> places;
            for (std::size_t n = 0; n + 1 < segments; ++n)
                places.push_back(whole * (0.02 + 0.96 * random.uniform(draw++)));
            std::ranges::sort(places);
            const bool is_apart =
                std::ranges::adjacent_find(places, [](double a, double b) { return b - a < 2.0 * mm; }) == places.end();
            if (!is_apart) continue;
            const CurveSplit random_one = split_at(curve, places);
            bool is_allowed = true;
            for (std::size_t n = 0; n < segments; ++n)
                is_allowed = is_allowed && glm::length(random_one.joints[n + 1] - random_one.joints[n]) >= 15.0 * mm;
            worse += is_allowed && random_one.rms < best.rms - 1e-9;
        }
    }
    CHECK(found >= 95);
    CHECK(worse == 0);
}

TEST_CASE("a split of a jaw's curve keeps to the least segment or is refused") {
    std::vector<Vec3> arc;
    for (int n = 0; n <= 90; ++n)
        arc.emplace_back(40.0 * mm * std::cos(n * 1.5 * degree), 40.0 * mm * std::sin(n * 1.5 * degree), 0.0);
    const CurveSplit three = split_curve(arc, 3, 20.0 * mm);
    // On an arc equal segments are best: the rise of a chord over 45° is r (1 - cos 22.5°).
    for (std::size_t n = 0; n < 3; ++n)
        CHECK(glm::length(three.joints[n + 1] - three.joints[n]) ==
              Approx(80.0 * mm * std::sin(22.5 * degree)).margin(0.5 * mm));
    CHECK(three.greatest == Approx(40.0 * mm * (1.0 - std::cos(22.5 * degree))).margin(0.05 * mm));
    CHECK(split_curve(arc, 1, 20.0 * mm).joints.size() == 2);
    using Catch::Matchers::ContainsSubstring;
    CHECK_THROWS_WITH(split_curve(arc, 5, 20.0 * mm), ContainsSubstring("has no room for 5 segments"));
    CHECK_THROWS_WITH(split_curve(arc, 6, 1.0 * mm), ContainsSubstring("6 segments"));
    CHECK_THROWS_AS(split_curve(std::vector{Vec3(0.0), Vec3(0.0)}, 1, 0.0), Error);
    CHECK_THROWS_AS(split_curve(std::vector{Vec3(0.0), Vec3(std::nan(""))}, 1, 0.0), Error);
}

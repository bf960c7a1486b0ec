// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/path_alignment.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

using namespace tactus;

TEST_CASE("an aligned recording goes deepest where it is told to, upright there, and keeps every relative motion") {
    const Vec3 feed(0.0, 0.0, -1.0);
    const Quat held = glm::angleAxis(2.5, glm::normalize(Vec3(1.0, 2.0, 0.5)));
    std::vector<simulate::TrajectorySample> samples;
    for (int i = 0; i < 400; ++i) {
        const double t = 0.01 * i;
        const double sign = i % 2 ? -1.0 : 1.0;  // the same rotation, written both ways
        samples.push_back({t, {Vec3(0.3 + 0.02 * std::sin(t), -0.2, 0.5 + 0.03 * std::cos(2.0 * t)), held * sign}});
    }
    const std::vector<simulate::TrajectorySample> before = samples;
    simulate::align_to_rest(samples, feed, 0.009);
    double deepest = -1.0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        deepest = std::max(deepest, glm::dot(samples[i].pose.position, feed));
        const Vec3 moved = samples[i].pose.position - samples[i - 1].pose.position;
        CHECK(glm::length(moved - (before[i].pose.position - before[i - 1].pose.position)) < 1e-12);
        CHECK(std::abs(samples[i].pose.orientation.w) == Approx(1.0));
        CHECK(samples[i].time == before[i].time);
    }
    CHECK(deepest == Approx(0.009).margin(1e-9));
    std::vector<simulate::TrajectorySample> none;
    simulate::align_to_rest(none, feed, 0.01);
    CHECK(none.empty());
}

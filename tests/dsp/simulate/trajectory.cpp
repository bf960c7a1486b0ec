// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/trajectory.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

/// A path with a sine in x and a turn about z, sampled at 62.5 Hz.
std::vector<simulate::TrajectorySample> recorded(double begin, double end, double offset = 0.0) {
    std::vector<simulate::TrajectorySample> samples;
    for (double t = begin; t < end; t += 0.016) {
        const double s = std::sin(2.0 * t);
        samples.push_back({t, {{offset + 0.02 * s, 0.01 * t, 0.0}, rotation_by({0.0, 0.0, s})}});
    }
    return samples;
}

simulate::TrajectoryPlayer with_gap(double gap, double jump) {
    std::vector<simulate::TrajectorySample> all = recorded(0.0, 0.5);
    const std::vector<simulate::TrajectorySample> later =
        recorded(all.back().time + gap, all.back().time + gap + 0.5, jump);
    all.insert(all.end(), later.begin(), later.end());
    return {all, {}, {}};
}

}  // namespace

TEST_CASE("a spline through a smooth recording keeps its path, its speed and its turning") {
    const simulate::TrajectoryPlayer player(recorded(0.0, 3.0), {}, {});
    std::size_t hint = 0;
    for (double t = 0.2; t < 2.7; t += 0.001) {
        const simulate::Intention now = player.at(t, hint).intention;
        const double s = std::sin(2.0 * t), ds = 2.0 * std::cos(2.0 * t);
        REQUIRE(std::abs(now.pose.position.x - 0.02 * s) < 1e-6);
        REQUIRE(std::abs(now.twist.linear.x - 0.02 * ds) < 1e-4);
        REQUIRE(glm::length(rotation_between(rotation_by({0.0, 0.0, s}), now.pose.orientation)) < 1e-4);
        REQUIRE(std::abs(now.twist.angular.z - ds) < 1e-2);
    }
}

TEST_CASE("recorded samples are passed through exactly, and twist has no jump there") {
    const std::vector<simulate::TrajectorySample> samples = recorded(0.0, 1.0);
    const simulate::TrajectoryPlayer player(samples, {}, {});
    std::size_t hint = 0;
    for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
        const simulate::TrajectoryState before = player.at(samples[i].time - 1e-9, hint),
                                        after = player.at(samples[i].time, hint);
        REQUIRE(glm::distance(after.intention.pose.position, samples[i].pose.position) < 1e-9);
        REQUIRE(glm::distance(before.intention.twist.linear, after.intention.twist.linear) < 1e-6);
    }
}

TEST_CASE("a quaternion that changes sign between samples does not turn the hand round") {
    std::vector<simulate::TrajectorySample> samples = recorded(0.0, 1.0);
    for (std::size_t i = 0; i < samples.size(); i += 2) samples[i].pose.orientation = -samples[i].pose.orientation;
    const simulate::TrajectoryPlayer flipped(samples, {}, {}), plain(recorded(0.0, 1.0), {}, {});
    std::size_t a = 0, b = 0;
    for (double t = 0.0; t < 0.99; t += 0.001) {
        const Vec3 difference =
            rotation_between(flipped.at(t, a).intention.pose.orientation, plain.at(t, b).intention.pose.orientation);
        REQUIRE(glm::length(difference) < 1e-9);
    }
}

TEST_CASE("a gap is held, flagged, then crossed below the speed limit") {
    const simulate::TrajectoryPlayer player = with_gap(3.0, 0.05);
    CHECK(player.gaps() == 1);
    std::size_t hint = 0;
    double fastest = 0.0, furthest_step = 0.0;
    int flagged = 0, held = 0;
    Vec3 last = player.start().position;
    for (double t = 0.0; t < player.duration(); t += 0.001) {
        const simulate::TrajectoryState state = player.at(t, hint);
        furthest_step = std::max(furthest_step, glm::distance(state.intention.pose.position, last));
        last = state.intention.pose.position;
        if (!state.gap) continue;
        ++flagged;
        held += glm::length(state.intention.twist.linear) == 0.0;
        fastest = std::max(fastest, glm::length(state.intention.twist.linear));
    }
    CHECK(flagged == Approx(3000).margin(5));
    CHECK(held > 1500);
    CHECK(fastest <= 0.1 * (1.0 + 1e-9));
    CHECK(furthest_step < 0.11e-3);
}

TEST_CASE("a gap too short for the way across it is stretched, not jumped") {
    const simulate::TrajectoryPlayer quick = with_gap(0.06, 0.0), far = with_gap(0.06, 0.05);
    CHECK(far.duration() > quick.duration() + 0.8);
    std::size_t hint = 0;
    double furthest_step = 0.0;
    Vec3 last = far.start().position;
    for (double t = 0.0; t < far.duration(); t += 0.001) {
        const Vec3 now = far.at(t, hint).intention.pose.position;
        furthest_step = std::max(furthest_step, glm::distance(now, last));
        last = now;
    }
    CHECK(furthest_step < 0.11e-3);
}

TEST_CASE("before the start and after the end the ends hold at rest") {
    const simulate::TrajectoryPlayer player(recorded(0.0, 1.0), {}, {});
    std::size_t hint = 0;
    const simulate::TrajectoryState after = player.at(100.0, hint), before = player.at(-1.0, hint);
    CHECK(after.done);
    CHECK(glm::length(after.intention.twist.linear) == 0.0);
    CHECK(glm::length(before.intention.twist.linear) == 0.0);
    CHECK(before.intention.pose.position == player.start().position);
}

TEST_CASE("where the walk came from does not change what is played") {
    const simulate::TrajectoryPlayer player = with_gap(0.3, 0.01);
    std::size_t forward = 0;
    for (double t = 0.0; t < player.duration(); t += 0.01) {
        std::size_t fresh = 0;
        REQUIRE(player.at(t, forward).intention.pose.position == player.at(t, fresh).intention.pose.position);
    }
}

TEST_CASE("one sample is a trajectory that stands still, none is an error") {
    const std::vector<simulate::TrajectorySample> one = {{5.0, {{1.0, 2.0, 3.0}, {1.0, 0.0, 0.0, 0.0}}}};
    std::size_t hint = 0;
    CHECK(simulate::TrajectoryPlayer(one, {}, {}).at(0.5, hint).intention.pose.position.y == 2.0);
    CHECK_THROWS_AS(simulate::TrajectoryPlayer(std::vector<simulate::TrajectorySample>{}, {}, {}), Error);
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/training/motion.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "tests/dsp/training/block.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;
using training::AttemptSample;

namespace {

/// Strokes of 16 mm at 1 Hz for `seconds`, fed at 1 mm/s, with tremor of that amplitude and a force along the feed.
std::vector<AttemptSample> sawing(double seconds, double tremor, double force) {
    std::vector<AttemptSample> samples;
    for (int n = 0; n <= static_cast<int>(seconds * 1000.0); ++n) {
        const double t = n * 1e-3;
        AttemptSample s;
        s.time = t;
        s.pose.position = {8 * mm * std::cos(2 * pi * t), tremor * std::sin(2 * pi * 9.0 * t), 8 * mm - 1 * mm * t};
        s.force = {0.0, 0.0, force};
        s.contact = true;
        samples.push_back(s);
    }
    return samples;
}

training::Track minimum_jerk(double distance, double seconds) {
    training::Track track;
    const int count = static_cast<int>(seconds * 1000.0);
    for (int n = -50; n <= count + 50; ++n) {
        const double s = std::clamp(static_cast<double>(n) / count, 0.0, 1.0);
        track.position.emplace_back(distance * s * s * s * (10.0 + s * (6.0 * s - 15.0)), 0.0, 0.0);
    }
    return track;
}

}  // namespace

TEST_CASE("the log dimensionless jerk of known movements is what calculus says, at any size and pace") {
    for (const auto& [distance, seconds] : {std::pair{16 * mm, 0.5}, std::pair{0.3, 2.0}}) {
        const training::Track track = minimum_jerk(distance, seconds);
        const auto jerk = training::log_dimensionless_jerk(track, 50, 50 + static_cast<std::size_t>(seconds * 1000.0));
        REQUIRE(jerk);
        CHECK(std::abs(*jerk - std::log(204.8)) < 0.02);
    }
    // Half a period of a sine: π⁴/2.
    const training::MotionMeasures m = training::motion_of(sawing(10.0, 0.0, 5.0), test::block_plan(), INFINITY);
    REQUIRE(m.jerk);
    CHECK(std::abs(*m.jerk - std::log(0.5 * pi * pi * pi * pi)) < 0.1);
}

TEST_CASE("strokes, path and force are those of the movement") {
    const auto samples = sawing(10.0, 0.0, 5.0);
    const training::MotionMeasures m = training::motion_of(samples, test::block_plan(), 4.0);
    CHECK(m.strokes == 10);
    CHECK(std::abs(m.path - 0.32) < 0.02 * 0.32);
    CHECK(std::abs(m.mean_force - 5.0) < 1e-9);
    CHECK(std::abs(m.over_limit - 10.0) < 0.01);
    CHECK(m.begin == 0.0);
    CHECK(std::abs(m.end - 10.0) < 1e-9);
}

TEST_CASE("time in the bone without force on the hand is counted, and time outside of it is not") {
    auto samples = sawing(10.0, 0.0, 5.0);
    CHECK(training::motion_of(samples, test::block_plan(), INFINITY).without_force == 0.0);
    for (AttemptSample& s : samples) {
        if (s.time >= 2.0 && s.time < 4.0) s.force = {};
        if (s.time < 1.0) s.contact = false;
        if (s.time < 0.5) s.force = {};
    }
    const training::MotionMeasures m = training::motion_of(samples, test::block_plan(), INFINITY);
    CHECK(std::abs(m.without_force - 2.0) < 2e-3);
    CHECK(std::abs(m.contact - 9.0) < 2e-3);

    // A blade that grazes the bone has no force for some ticks: none was taken away.
    auto grazing = sawing(10.0, 0.0, 5.0);
    for (std::size_t n = 0; n < grazing.size(); ++n)
        if (n % 100 < 20) grazing[n].force = {};
    CHECK(training::motion_of(grazing, test::block_plan(), INFINITY).without_force == 0.0);
}

TEST_CASE("a trembling hand has more jerk and a longer path, and no more strokes") {
    const auto calm = training::motion_of(sawing(6.0, 0.0, 5.0), test::block_plan(), INFINITY);
    const auto trembling = training::motion_of(sawing(6.0, 0.5 * mm, 5.0), test::block_plan(), INFINITY);
    CHECK(*trembling.jerk > *calm.jerk + 1.0);
    CHECK(trembling.path > 1.05 * calm.path);
    CHECK(trembling.strokes == calm.strokes);
}

TEST_CASE("noise of a device far above the band of hands adds little jerk") {
    auto noisy = sawing(6.0, 0.0, 5.0);
    const auto clean = training::motion_of(noisy, test::block_plan(), INFINITY);
    const Random random{7};
    for (std::size_t n = 0; n < noisy.size(); ++n)
        for (int a = 0; a < 3; ++a)
            noisy[n].pose.position[a] += 2e-6 * (2.0 * random.uniform(3 * n + static_cast<std::size_t>(a)) - 1.0);
    const auto measured = training::motion_of(noisy, test::block_plan(), INFINITY);
    CHECK(std::abs(*measured.jerk - *clean.jerk) < 0.2);
}

TEST_CASE("a break-through is how far and how fast the blade went beyond the bone") {
    std::vector<AttemptSample> samples;
    for (int n = 0; n < 3000; ++n) {
        const double t = n * 1e-3;
        // 2 mm/s up to the far side at 16 mm (2 s), then 3 mm deep at up to 30 mm/s, then back.
        double depth = 12 * mm + 2 * mm * std::min(t, 2.0);
        if (t > 2.0) depth += t < 2.2 ? 1.5 * mm * (1.0 - std::cos(pi * (t - 2.0) / 0.2)) : 3 * mm;
        AttemptSample s;
        s.time = t;
        s.pose.position = {0.0, 0.0, 8 * mm - depth};
        s.contact = t <= 2.0;
        samples.push_back(s);
    }
    const training::Severance bone{true, 16 * mm, -5 * mm, 5 * mm};
    const auto found = training::breakthrough_of(samples, test::block_plan(), {}, bone);
    REQUIRE(found);
    CHECK(std::abs(found->depth - 3 * mm) < 0.02 * mm);
    CHECK(std::abs(found->speed - 1.5 * mm * pi / 0.2) < 0.03 * 1.5 * mm * pi / 0.2);
    samples.resize(1500);
    CHECK_FALSE(training::breakthrough_of(samples, test::block_plan(), {}, bone));
}

TEST_CASE("an attempt without a touch, and one of a single sample, have no movement") {
    auto samples = sawing(1.0, 0.0, 0.0);
    for (AttemptSample& s : samples) s.contact = false;
    const auto none = training::motion_of(samples, test::block_plan(), 1.0);
    CHECK(none.strokes == 0);
    CHECK(none.path == 0.0);
    CHECK_FALSE(none.jerk);
    samples.resize(1);
    samples.front().contact = true;
    CHECK(training::motion_of(samples, test::block_plan(), 1.0).path == 0.0);
    CHECK(training::motion_of({}, test::block_plan(), 1.0).path == 0.0);
}

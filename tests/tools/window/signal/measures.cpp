// SPDX-License-Identifier: Apache-2.0
#include "tools/window/signal/measures.hpp"

#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus::window;
using tactus::pi;

namespace {

constexpr double trace_rate = 8000.0;

/// Columns: a sine of 100 Hz and amplitude 2, a cosine of it with amplitude 0.5.
Trace tones(double seconds, double frequency = 100.0) {
    Trace trace;
    trace.columns.resize(2);
    for (int k = 0; k < static_cast<int>(seconds * trace_rate); ++k) {
        const double t = k / trace_rate;
        trace.times.push_back(t);
        trace.columns[0].push_back(2.0 * std::sin(2.0 * pi * frequency * t));
        trace.columns[1].push_back(0.5 * std::cos(2.0 * pi * frequency * t));
    }
    return trace;
}

}  // namespace

TEST_CASE("a trigger is the latest crossing of its level in its direction, between samples") {
    const Trace trace = tones(1.0);
    // sin passes 0 upwards at multiples of 10 ms, and 1 of 2 at a twelfth of a cycle later.
    CHECK(trigger_time(trace, 0, {0.0, true}, {0.0, 0.505}).value() == Approx(0.50).margin(1e-6));
    CHECK(trigger_time(trace, 0, {1.0, true}, {0.0, 0.505}).value() == Approx(0.50 + 0.01 / 12.0).margin(1e-6));
    CHECK(trigger_time(trace, 0, {0.0, false}, {0.0, 0.504}).value() == Approx(0.495).margin(1e-6));
    // Never after the end of the range, nor before its begin.
    CHECK(trigger_time(trace, 0, {0.0, true}, {0.0, 0.4999}).value() == Approx(0.49).margin(1e-6));
    CHECK_FALSE(trigger_time(trace, 0, {0.0, true}, {0.491, 0.499}));
    CHECK_FALSE(trigger_time(trace, 0, {2.5, true}, {0.0, 1.0}));
    CHECK_FALSE(trigger_time(trace, 7, {0.0, true}, {0.0, 1.0}));
    CHECK_FALSE(trigger_time({}, 0, {0.0, true}, {0.0, 1.0}));
}

TEST_CASE("levels are those of a sine: peak, root mean square, mean and their dB") {
    const Trace trace = tones(1.0);
    const Level level = level_of(trace, 0, {0.1, 0.1 + 799.5 / trace_rate});
    CHECK(level.count == 800);
    CHECK(level.peak() == Approx(2.0));
    CHECK(level.rms == Approx(2.0 / std::sqrt(2.0)));
    CHECK(level.mean == Approx(0.0).margin(1e-12));
    CHECK(decibels(level.peak()) == Approx(6.0206).epsilon(1e-4));
    CHECK(decibels(level_of(trace, 1, {0.1, 0.1 + 799.5 / trace_rate}).rms) == Approx(-9.0309).epsilon(1e-4));
    CHECK(decibels(0.0) == -240.0);
    Trace odd = trace;
    odd.columns[0][10] = std::numeric_limits<double>::quiet_NaN();
    odd.columns[0][11] = std::numeric_limits<double>::infinity();
    CHECK(level_of(odd, 0, {0.0, 1.0}).count == odd.times.size() - 2);
    CHECK(level_of(odd, 0, {0.0, 1.0}).peak() == Approx(2.0));
    CHECK(level_of({}, 0, {0.0, 1.0}).count == 0);
}

TEST_CASE("the histogram of a sine is that of the arc sine law, and counts every value once") {
    const Trace trace = tones(10.0, 97.3);
    const Histogram histogram = histogram_of(trace, 0, {0.0, 10.0}, 20);
    CHECK(histogram.total == trace.times.size());
    std::size_t sum = 0;
    for (std::size_t k = 0; k < 20; ++k) {
        sum += histogram.counts[k];
        const auto share = [](double x) { return std::asin(std::clamp(x, -1.0, 1.0)) / pi; };
        const double wanted =
            share(-1.0 + 0.1 * static_cast<double>(k + 1)) - share(-1.0 + 0.1 * static_cast<double>(k));
        CHECK(static_cast<double>(histogram.counts[k]) / static_cast<double>(histogram.total) ==
              Approx(wanted).margin(0.002));
    }
    CHECK(sum == histogram.total);
    Trace still = trace;
    for (double& x : still.columns[0]) x = 3.0;
    CHECK(histogram_of(still, 0, {0.0, 1.0}, 4).total == 8001);
    CHECK(histogram_of({}, 0, {0.0, 1.0}, 4).total == 0);
}

TEST_CASE("pairs of sine and cosine lie on their ellipse, and a slower signal is held") {
    const Trace trace = tones(1.0);
    const Pairs pairs = pairs_of(trace, 0, trace, 1, {0.0, 1.0}, 500);
    CHECK(pairs.points.size() == 500);
    for (const Point& p : pairs.points) CHECK(std::pow(p.x / 2.0, 2.0) + std::pow(p.y / 0.5, 2.0) == Approx(1.0));
    Trace slow;
    slow.times = {0.1, 0.3};
    slow.columns = {{5.0, 7.0}};
    const auto held = pairs_of(slow, 0, trace, 1, {0.0, 0.5}, 100'000).points;
    CHECK(held.size() == 3201);  // none before the first value
    CHECK(held.front().x == 5.0);
    CHECK(held.back().x == 7.0);
}

TEST_CASE("of many pairs the newest are shown one after another with how far back they go") {
    const Trace trace = tones(1.0);
    const Pairs pairs = pairs_of(trace, 0, trace, 1, {0.0, 1.0}, 500);
    CHECK(pairs.is_cut);
    CHECK(pairs.since == Approx(trace.times[8000 - 500]));
    REQUIRE(pairs.points.size() == 500);
    for (std::size_t i = 0; i < 500; ++i) CHECK(pairs.points[i].x == trace.columns[0][7500 + i]);
    CHECK_FALSE(pairs_of(trace, 0, trace, 1, {0.0, 1.0}, 8000).is_cut);
}

TEST_CASE("a waterfall begins at its first bin and names the bin of each cell") {
    const Waterfall all = waterfall_of(tones(2.0, 1000.0), 0, trace_rate, {0.0, 2.0}, 48, 160);
    // 2 s of 8 kHz in 48 rows: segments of 64 samples.
    CHECK(all.hz.low == Approx(125.0));
    CHECK(all.bins[all.index_of(10, 0)] == Approx(125.0));
    CHECK(all.bins[all.index_of(10, 159)] == Approx(4000.0));
    for (int c = 0; c < 160; ++c) {
        const double hz = all.hz.low * std::pow(all.hz.high / all.hz.low, (c + 0.5) / 160);
        CHECK(std::abs(all.bins[all.index_of(10, c)] - hz) <= 63.0);
    }
}

TEST_CASE("a waterfall shows a tone where it is, when it is") {
    // 200 Hz in the first half, 1600 Hz in the second.
    Trace trace;
    trace.columns.resize(1);
    for (int k = 0; k < 16000; ++k) {
        const double t = k / trace_rate;
        trace.times.push_back(t);
        trace.columns[0].push_back(std::sin(2.0 * pi * (t < 1.0 ? 200.0 : 1600.0) * t));
    }
    const Waterfall all = waterfall_of(trace, 0, trace_rate, {0.0, 2.0}, 8, 50);
    REQUIRE(all.rows == 8);
    REQUIRE(all.cells.size() == 400);
    for (int row = 0; row < 8; ++row) {
        int loudest = 0;
        for (int c = 0; c < 50; ++c)
            if (all.at(row, c) > all.at(row, loudest)) loudest = c;
        const double hz = all.bins[all.index_of(row, loudest)];
        CAPTURE(row, hz);
        CHECK(hz == Approx(row < 4 ? 200.0 : 1600.0).epsilon(0.1));
        CHECK(all.at(row, loudest) > all.at(row, row < 4 ? 49 : 0) + 40.0);
    }
    // Where there are no values yet, nothing is shown.
    CHECK(waterfall_of(trace, 0, trace_rate, {-2.0, 2.0}, 8, 50).at(0, 10) == -240.0);
    CHECK(waterfall_of({}, 0, trace_rate, {0.0, 1.0}, 8, 50).rows == 0);
}

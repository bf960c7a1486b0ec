// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/level.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

/// A tone of that amplitude, cut at ±1 and rounded to steps of `quantum` (0: not).
signal::Level of_tone(double amplitude, double quantum) {
    std::vector<double> x(48000);
    for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = std::clamp(amplitude * std::sin(2.0 * std::numbers::pi * 100.0 * static_cast<double>(i) / 48000.0), -1.0,
                          1.0);
        if (quantum > 0.0) x[i] = quantum * std::round(x[i] / quantum);
    }
    signal::Level level;
    level.push(x);
    return level;
}

}  // namespace

TEST_CASE("a wave that was cut off is told from one whose top was rounded to a few bits") {
    for (const double quantum : {0.0, 1.0 / 32768.0, 1.0 / 128.0}) {
        INFO("steps of " << quantum);
        CHECK(of_tone(0.7, quantum).clipped() == 0);
        // A tone of amplitude 2 is beyond 1 for two thirds of the time.
        CHECK(static_cast<double>(of_tone(2.0, quantum).clipped()) == Approx(48000.0 * 2.0 / 3.0).epsilon(0.01));
    }
}

TEST_CASE("a large offset does not blur the level of a small vibration") {
    std::vector<double> x(48000);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = 1e6 + 1e-3 * std::sin(2.0 * std::numbers::pi * 100.0 * static_cast<double>(i) / 48000.0);
    signal::Level level;
    level.push(x);
    CHECK(level.mean() == Approx(1e6));
    CHECK(level.rms() == Approx(1e-3 / std::numbers::sqrt2).epsilon(1e-5));
}

TEST_CASE("a level does not depend on the pieces that a record comes in, nor on where it stands between its limits") {
    // Runs at the limits and at other values, steps of a converter, and long quiet parts in which blocks are skipped.
    const Random random{9};
    std::vector<double> x;
    for (std::size_t i = 0; x.size() < 20000; ++i) {
        const double value = std::round(100.0 * random.normal(i)) / 64.0;
        const bool is_loud = i % 700 < 60;
        x.insert(x.end(), 1 + i % 5, std::clamp(is_loud ? 3.0 * value : 0.1 * value, -2.0, 2.0));
        if (i % 1000 == 999) x.insert(x.end(), 300, 0.015625);
    }
    signal::Level whole;
    whole.push(x);
    CHECK(whole.clipped() > 100);
    double mean = 0.0, squares = 0.0;
    for (const double v : x) mean += v / static_cast<double>(x.size());
    for (const double v : x) squares += (v - mean) * (v - mean);
    CHECK(whole.mean() == Approx(mean).epsilon(1e-10).margin(1e-14));
    CHECK(whole.rms() == Approx(std::sqrt(squares / static_cast<double>(x.size()))).epsilon(1e-12));
    for (const std::size_t piece : {1u, 3u, 64u, 1000u}) {
        CAPTURE(piece);
        signal::Level level;
        for (std::size_t i = 0; i < x.size(); i += piece)
            level.push(std::span(x).subspan(i, std::min(piece, x.size() - i)));
        CHECK(level.clipped() == whole.clipped());
        CHECK(level.rms() == whole.rms());
        CHECK(level.mean() == whole.mean());
        CHECK(level.peak() == whole.peak());
        CHECK(level.largest() == 2.0);
    }
}

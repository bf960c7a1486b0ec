// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/level.hpp"
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

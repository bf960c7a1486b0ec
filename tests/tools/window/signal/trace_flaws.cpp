// SPDX-License-Identifier: Apache-2.0
// Gaps and values that are not finite: a scope shows them as what they are, and measures what lies around them.
#include "tests/support/catch.hpp"
#include "tools/window/signal/plot.hpp"
#include "tools/window/signal/readings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;
using namespace tactus::window;

namespace {

constexpr double rate = 1000.0, no_number = std::numeric_limits<double>::quiet_NaN(),
                 infinite = std::numeric_limits<double>::infinity();
const Display newtons{1.0, "N", 1};

/// `value` at 1 kHz from 0 to 1 s, and from 3 to 4 s.
template <class F>
Trace two_stretches(F&& value) {
    Trace trace{{}, {{}}, {"value"}, 1.0 / rate};
    for (int k = 0; k < 4000; ++k) {
        if (k >= 1000 && k < 3000) continue;
        trace.times.push_back(k / rate);
        trace.columns[0].push_back(value(k / rate));
    }
    return trace;
}

double flawed_tone(double t) { return std::sin(2.0 * std::numbers::pi * 100.0 * t); }

}  // namespace

TEST_CASE("nothing is read between two recorded stretches") {
    const Trace trace = two_stretches([](double t) { return t; });
    const Plot plot = time_plot(trace, newtons, 4.0, 4.0, 10'000);
    const DrawnTrace drawn{&trace, newtons};
    const Point within{0.5005, 0.0}, between{2.0, 0.0};
    CHECK(wave_words(plot, drawn, std::span(&within, 1)) == "0.500500 s: 0.5005 N");
    CHECK(wave_words(plot, drawn, std::span(&between, 1)) == "2.000000 s: – N");
    CHECK(flaw_words(flaws_of(trace, 0, {0.0, 4.0})) == "2000 values lost");
    CHECK(flaw_words(flaws_of(trace, 0, {2.0, 4.0})) == "1000 values lost");
    CHECK(flaw_words(flaws_of(trace, 0, {3.0, 4.0})).empty());
}

TEST_CASE("a curve has no line across a gap, whether it is drawn as points or as an envelope") {
    const Trace trace = two_stretches(flawed_tone);
    for (const int pixels : {10'000, 100}) {
        const Plot plot = time_plot(trace, newtons, 4.0, 4.0, pixels);
        CAPTURE(pixels);
        const auto pieces = pieces_of(plot.curves[0]);
        REQUIRE(pieces.size() == 2);
        CHECK(pieces[0].back().x < 1.03);
        CHECK(pieces[1].front().x > 2.97);
    }
}

TEST_CASE("a trigger finds no crossing within a gap") {
    const Trace trace = two_stretches([](double t) { return t < 2.0 ? -1.0 : 1.0; });
    CHECK_FALSE(trigger_time(trace, 0, {0.0, true}, {0.0, 4.0}));
}

TEST_CASE("the spectrum of a tone in two stretches has no noise of the jump between them") {
    // To join the stretches would be a step of 100.
    const Trace trace = two_stretches([](double t) { return flawed_tone(t) + (t < 2.0 ? 0.0 : 100.0); });
    const signal::Spectrum spectrum = spectrum_of(trace, 0, rate, {0.0, 4.0});
    REQUIRE(spectrum.power.size() > 50);
    for (std::size_t k = 2; k < spectrum.power.size(); ++k)
        if (std::abs(spectrum.frequency(k) - 100.0) > 20.0) CHECK(spectrum.power[k] < 1e-4);
}

TEST_CASE("one value that is not finite leaves the rest of a spectrum as it is") {
    for (const double odd : {no_number, infinite}) {
        Trace trace = two_stretches(flawed_tone);
        trace.columns[0][100] = odd;
        const Plot plot = spectrum_plot(trace, 0, newtons, rate, 4.0, 4.0, {});
        REQUIRE(plot.curves[0].points.size() > 50);
        for (const Point& p : plot.curves[0].points) CHECK(std::isfinite(p.y));
        CHECK(std::ranges::max_element(plot.curves[0].points, {}, &Point::y)->x == Approx(100.0).margin(4.0));
        CHECK(flaws_of(trace, 0, {0.0, 1.0}).not_finite == 1);
    }
}

TEST_CASE("a value that is not finite erases no extreme of its pixel, and the axis keeps to the others") {
    std::vector<double> times, values;
    for (int k = 0; k < 1000; ++k) {
        times.push_back(k / rate);
        values.push_back(k == 500 ? 7.0 : k == 505 ? no_number : k == 507 ? infinite : 1.0);
    }
    const Envelope envelope = envelope_of(times, values, {0.0, 1.0}, 10, 1.0 / rate);
    CHECK(envelope.high[5] == 7.0);
    CHECK(envelope.low[5] == 1.0);
    CHECK_FALSE(envelope.begins[5]);

    Trace trace{times, {values}, {"value"}, 1.0 / rate};
    for (double& value : trace.columns[0]) value = value == 1.0 ? 4.0 : value;
    for (const int pixels : {10'000, 100}) {
        const Plot plot = time_plot(trace, newtons, 1.0, 1.0, pixels);
        CAPTURE(pixels);
        CHECK((plot.y.low < 4.0 && plot.y.high > 7.0 && plot.y.high < 8.0));
        for (const Point& p : plot.curves[0].points) CHECK(std::isfinite(p.y));
    }
    CHECK(pieces_of(time_plot(trace, newtons, 1.0, 1.0, 10'000).curves[0]).size() == 3);
    CHECK(flaw_words(flaws_of(trace, 0, {0.0, 1.0})) == "2 values not finite");
}

TEST_CASE("pairs are not joined across a gap, and a value of long ago is not held for ever") {
    const Trace y = two_stretches(flawed_tone);
    Trace x = y;
    const Pairs both = pairs_of(x, 0, y, 0, {0.0, 4.0}, 10'000);
    CHECK(both.points.size() == 2000);
    CHECK(both.begins == std::vector<std::size_t>{1000});
    x.times.resize(1000);
    x.columns[0].resize(1000);
    CHECK(pairs_of(x, 0, y, 0, {0.0, 4.0}, 10'000).points.size() == 1000);
}

// SPDX-License-Identifier: Apache-2.0
// Every number that a scope shows, of signals whose numbers are known.
#include "tools/window/signal/readings.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/signal/level_meter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace tactus;
using namespace tactus::window;

namespace {

constexpr double card_rate = 48000.0;
const Display volts{1.0, "V", 1};

template <class F>
Trace trace_of(double seconds, F&& value) {
    Trace trace;
    trace.names = {"value"};
    trace.columns.resize(1);
    for (int k = 0; k < static_cast<int>(seconds * card_rate); ++k) {
        trace.times.push_back(k / card_rate);
        trace.columns[0].push_back(value(k / card_rate));
    }
    return trace;
}
Trace sine(double seconds, double amplitude, double hz) {
    return trace_of(seconds, [=](double t) { return amplitude * std::sin(2.0 * pi * hz * t); });
}

}  // namespace

TEST_CASE("half an amplitude is -6.02 dB, and its root mean square 3.01 dB less, with what 0 dB is") {
    const Trace half = sine(1.0, 0.5, 100.0);
    CHECK(level_words(level_of(half, 0, {0.0, 1.0}), "V") == "peak -6.02 dB, rms -9.03 dB re 1 V");
    CHECK(level_words(level_of(sine(1.0, 10.0, 100.0), 0, {0.0, 1.0}), "", "fx") ==
          "fx: peak 20.00 dB, rms 16.99 dB re 1");
    CHECK(level_words({}, "V").empty());
    CHECK(meter_share(6.0) == 1.0);
    CHECK(meter_share(-60.0) == 0.0);
    CHECK(meter_share(-27.0) == Approx(0.5));
    CHECK(meter_share(-240.0) == 0.0);
}

TEST_CASE("cursors of a wave give time, value, their differences and the frequency, however many samples a pixel has") {
    // A ramp of 3 V/s: what lies between two cursors is known.
    const Trace ramp = trace_of(2.0, [](double t) { return 3.0 * t; });
    for (const int pixels : {40, 1'000'000}) {
        const Plot plot = time_plot(ramp, volts, 2.0, 2.0, pixels);
        const DrawnTrace drawn{&ramp, volts};
        const Point one{0.5, 0.0}, two{0.505, 9.0};
        const Point both[] = {one, two}, back[] = {two, one};
        CHECK(wave_words(plot, drawn, std::span(&one, 1)) == "0.500000 s: 1.5 V");
        CHECK(wave_words(plot, drawn, both) == "Δ 5.000 ms, Δ 0.015 V, 200 Hz");
        CHECK(wave_words(plot, drawn, back) == "Δ -5.000 ms, Δ -0.015 V, 200 Hz");
        const Point far[] = {{0.25, 0.0}, {1.75, 0.0}};
        CHECK(wave_words(plot, drawn, far) == "Δ 1.5000 s, Δ 4.5 V, 0.66667 Hz");
        // The value beside the name is the latest, not the largest of the last pixel.
        CHECK(plot.curves[0].last.value() == Approx(3.0 * (2.0 - 1.0 / card_rate)));
    }
    // Between two samples, and outside of the trace.
    const Trace slow{{0.0, 1.0}, {{0.0, 10.0}}, {"value"}};
    const Plot plot = time_plot(slow, volts, 1.0, 2.0, 100);
    const Point between{0.25, 0.0}, before{-0.5, 0.0};
    CHECK(wave_words(plot, {&slow, volts}, std::span(&between, 1)) == "0.250000 s: 2.5 V");
    CHECK(wave_words(plot, {&slow, volts}, std::span(&before, 1)) == "-0.500000 s: – V");
    CHECK(wave_words(plot, {nullptr, volts}, std::span(&before, 1)).empty());
}

TEST_CASE("a triggered wave counts time from the crossing, so that cursors stay on what they point at") {
    const Trace tone = sine(1.0, 2.0, 50.0);
    for (const double now : {0.71, 0.737, 0.999}) {
        const double at = trigger_time(tone, 0, {1.0, true}, {0.0, now - 0.09}).value();
        const Plot plot = time_plot(tone, volts, at + 0.09, 0.1, 400, at);
        CHECK(plot.x.low == Approx(-0.01));
        CHECK(plot.x.high == Approx(0.09));
        // A quarter of a cycle after 1 of 2 at 30°: 2 sin(120°).
        const Point cursor{5e-3, 0.0};
        CHECK(wave_words(plot, {&tone, volts}, std::span(&cursor, 1)) == "5.000 ms: 1.732 V");
        double nearest = 1.0;
        for (const Point& p : plot.curves[0].points)
            if (std::abs(p.x) < 2e-4) nearest = std::min(nearest, std::abs(p.y - 1.0));
        CHECK(nearest < 0.15);  // half a pixel
    }
}

TEST_CASE("the level of a tone in a spectrum is its power over the window's bandwidth, that of noise its density") {
    // At the middle of a bin; a Hann window has a bandwidth of 1.5 bins.
    const std::size_t segment = signal::suggested_segment(card_rate, static_cast<std::size_t>(card_rate));
    const double df = card_rate / static_cast<double>(segment), hz = df * std::round(1000.0 / df);
    const Plot plot = spectrum_plot(sine(1.0, 0.5, hz), 0, volts, card_rate, 1.0, 1.0, {});
    const double wanted = 10.0 * std::log10(0.5 * 0.5 / 2.0 / (1.5 * df));
    const Point at{hz, 0.0};
    const std::string words = spectrum_words(plot, std::span(&at, 1));
    CHECK(words == fmt::format("{:.5g} Hz: {:.2f} dB re (V)²/Hz", hz, wanted));
    const Plot full = spectrum_plot(sine(1.0, 1.0, hz), 0, volts, card_rate, 1.0, 1.0, {});
    CHECK(spectrum_words(full, std::span(&at, 1)) ==
          fmt::format("{:.5g} Hz: {:.2f} dB re (V)²/Hz", hz, wanted + 20.0 * std::log10(2.0)));

    std::mt19937 random(1);
    std::normal_distribution<double> normal(0.0, 0.1);
    const Trace noise = trace_of(10.0, [&](double) { return normal(random); });
    const Plot flat = spectrum_plot(noise, 0, volts, card_rate, 10.0, 10.0, {});
    double sum = 0.0;
    int count = 0;
    for (const Point& p : flat.curves[0].points)
        // Above, a drawn point is the largest of several bins.
        if (p.x > 20.0 && p.x < 300.0) sum += std::pow(10.0, 0.1 * p.y), ++count;
    REQUIRE(count > 5);
    CHECK(10.0 * std::log10(sum / count) == Approx(10.0 * std::log10(0.01 / (0.5 * card_rate))).margin(1.0));
}

TEST_CASE("a waterfall tells the level of the cell under the pointer, and the difference of two") {
    // 100 times the power in the second half.
    const Trace trace = trace_of(2.0, [](double t) { return (t < 1.0 ? 0.1 : 1.0) * std::sin(2.0 * pi * 1000.0 * t); });
    const Plot plot = waterfall_plot(trace, 0, volts, card_rate, 2.0, 2.0);
    const Point at[] = {{1000.0, 0.5}, {1000.0, 1.5}};
    CHECK(waterfall_words(plot, at) == "Δ 0 Hz, Δ 20.00 dB");
    const std::string one = waterfall_words(plot, std::span(at).subspan(1, 1));
    CHECK(one.starts_with("937.5 Hz: "));
    CHECK(one.ends_with(" dB re (V)²/Hz"));
    CHECK(waterfall_words({}, at).empty());
    // Before the first value nothing was measured.
    const Plot early = waterfall_plot(trace, 0, volts, card_rate, 2.0, 4.0);
    const Point before{1000.0, -1.5};
    CHECK(waterfall_words(early, std::span(&before, 1)).empty());
}

TEST_CASE("a histogram tells the share of the part under the pointer, and that between two cursors") {
    // Even between 0 and 6: each of 60 parts has a sixtieth.
    const Trace even = trace_of(1.0, [](double t) { return 6.0 * t * card_rate / (card_rate - 1.0); });
    const Plot plot = histogram_plot(even, 0, volts, 1.0, 1.0);
    for (const double x : {0.01, 0.09, 3.01, 3.09, 5.99}) {
        const Point at{x, 0.0};
        const double low = std::floor(x / 0.1) * 0.1;
        CHECK(histogram_words(plot, std::span(&at, 1)) == fmt::format("{:.4g} to {:.4g} V: 1.67 %", low, low + 0.1));
    }
    const Point at[] = {{1.5, 0.0}, {3.0, 0.0}}, outside{7.0, 0.0};
    CHECK(histogram_words(plot, at) == "Δ 1.5 V, 25.00 % between");
    CHECK(histogram_words(plot, std::span(&outside, 1)) == "7 V: 0 %");
    CHECK_FALSE(plot.curves[0].last);
}

TEST_CASE("a curve of pairs tells where the pointer is, in the units of both axes") {
    const Trace trace = sine(0.1, 1.0, 100.0);
    const Plot plot = xy_plot(trace, 0, volts, trace, 0, {1e3, "mm", 1}, 0.1, 0.1);
    const Point at[] = {{0.25, 250.0}, {0.5, 500.0}};
    CHECK(xy_words(plot, std::span(at).first(1)) == "0.25 V, 250 mm");
    CHECK(xy_words(plot, at) == "Δ 0.25 V, Δ 250 mm");
    CHECK(plot.value_at(plot.across(0.3)) == Approx(0.3));
    CHECK(plot.height_at(plot.up(300.0)) == Approx(300.0));
}

TEST_CASE("the peak of a tone is read at its frequency, however many bins share a step of the curve") {
    const double df = card_rate / 8192.0;
    for (const int bin : {171, 172, 173, 1000}) {
        const Plot plot = spectrum_plot(sine(1.0, 1.0, bin * df), 0, volts, card_rate, 1.0, 1.0, {});
        const auto& points = plot.curves[0].points;
        const double hz = std::ranges::max_element(points, {}, &Point::y)->x;
        CAPTURE(bin, bin * df);
        CHECK(hz == Approx(bin * df).margin(0.01));
    }
}

TEST_CASE("a spectrum begins at its first bin, and says when there are too few values") {
    const double slow = 100.0;
    Trace trace{{}, {{}}, {"value"}, 1.0 / slow};
    for (int k = 0; k < 2000; ++k) {
        trace.times.push_back(k / slow);
        trace.columns[0].push_back(std::sin(2.0 * pi * 3.125 * k / slow));
    }
    const Plot plot = spectrum_plot(trace, 0, volts, slow, 20.0, 20.0, {});
    CHECK(plot.x.low < 2.0);
    CHECK(plot.note.empty());
    CHECK(std::ranges::max_element(plot.curves[0].points, {}, &Point::y)->x == Approx(3.125).margin(0.01));
    CHECK(spectrum_plot(trace, 0, volts, slow, 20.0, 0.2, {}).note == "too few values for a spectrum");
    CHECK(waterfall_plot(trace, 0, volts, slow, 20.0, 0.2).note == "too few values for a spectrum");
}

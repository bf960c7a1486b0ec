// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/band_velocity.hpp"

#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/transform.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

using namespace tactus;

namespace {

constexpr double pi = std::numbers::pi;

/// Of 1 m/s² rms, plus an offset.
std::vector<double> sine(double hz, double rate, double seconds) {
    std::vector<double> x(static_cast<std::size_t>(seconds * rate));
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = 9.81 + std::numbers::sqrt2 * std::sin(2.0 * pi * hz * static_cast<double>(i) / rate + 0.7);
    return x;
}

double velocity(std::span<const double> x, double rate) {
    signal::BandVelocity band(10.0, 1000.0, rate);
    band.push(x.first(x.size() / 3));
    band.push(x.subspan(x.size() / 3));
    band.end_piece();
    REQUIRE(band.is_resolved());
    return band.rms();
}

/// The same by integration over time: the acceleration, silent before and after the record, through an ideal filter
/// from 10 to 1000 Hz, its integral, and the root mean square over the record.
double integrated(std::vector<double> x, double rate) {
    const std::size_t count = x.size();
    double mean = 0.0;
    for (const double value : x) mean += value / static_cast<double>(count);
    for (double& value : x) value -= mean;
    std::size_t size = 16;
    while (size < 4 * count + static_cast<std::size_t>(4.0 * rate)) size *= 2;
    std::vector<std::complex<double>> spectrum = signal::spectrum_of(x, size);
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
        const double hz = static_cast<double>(k) * rate / static_cast<double>(size);
        spectrum[k] = hz < 10.0 || hz > 1000.0 ? 0.0 : spectrum[k] / std::complex<double>(0.0, 2.0 * pi * hz);
    }
    double sum = 0.0;
    for (const double value : signal::samples_of(spectrum)) sum += value * value;
    return std::sqrt(sum / static_cast<double>(count));
}

/// A half sine of 2 ms, as of an impact of a hammer, that begins at `seconds`.
void add_impact(std::vector<double>& x, double rate, double seconds, double peak) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double t = static_cast<double>(i) / rate - seconds;
        if (t >= 0.0 && t < 2e-3) x[i] += peak * std::sin(pi * t / 2e-3);
    }
}

}  // namespace

TEST_CASE("velocity in a band is that of a sine from one border of the band to the other") {
    for (const double rate : {2000.0, 8000.0, 11025.0, 48000.0})
        for (const double seconds : {0.8, 1.3, 5.0, 20.0, 60.0}) {
            if (rate * seconds > 1e6) continue;
            // Half a period of 10 Hz is in the tapered ends, which matter in short records.
            const double within = seconds < 2.0 ? 0.02 : 2e-3;
            for (const double hz : {10.0, 10.2, 10.5, 11.0, 12.5, 16.3, 31.7, 100.0, 453.2, 871.0, 990.0}) {
                CAPTURE(rate, seconds, hz);
                CHECK(velocity(sine(hz, rate, seconds), rate) == Approx(1.0 / (2.0 * pi * hz)).epsilon(within));
            }
            // Outside nothing counts but what the side lobes of the window leave.
            if (rate > 2000.0)
                CHECK(velocity(sine(1000.0, rate, seconds), rate) == Approx(1.0 / (2000.0 * pi)).epsilon(within));
            for (const double hz : {5.0, 9.8}) {
                CAPTURE(rate, seconds, hz);
                CHECK(velocity(sine(hz, rate, seconds), rate) < (seconds < 2.0 ? 0.1 : 2e-2) / (2.0 * pi * hz));
            }
        }
}

TEST_CASE("velocity in a band has the energy of an impact wherever it is in the record") {
    for (const double rate : {4000.0, 48000.0})
        for (const double seconds : {1.0, 1.7, 3.1, 10.3})
            for (const double place : {0.15, 0.25, 0.4, 0.5, 0.77, 1.0, 1.35, 2.2, 2.9, 5.0, 9.9, 10.1}) {
                if (place > seconds - 0.15) continue;
                std::vector<double> x(static_cast<std::size_t>(seconds * rate));
                add_impact(x, rate, place, 50.0);
                CAPTURE(rate, seconds, place);
                // Within 0.2 s of an end a part counts; elsewhere the mean is over the covered part of the record.
                const bool is_inside = place > 0.3 && place < seconds - 0.3;
                const double ratio = velocity(x, rate) / integrated(x, rate);
                CHECK(ratio > (is_inside ? 0.97 : 0.6));
                CHECK(ratio < std::sqrt(seconds / (seconds - 0.25)) * 1.03);
            }
}

TEST_CASE("velocity in a band is that of an integration over time for impacts, sweeps and bursts") {
    constexpr double rate = 8000.0;
    const Random random(11);
    for (const double seconds : {2.0, 4.3, 12.0}) {
        CAPTURE(seconds);
        const auto count = static_cast<std::size_t>(seconds * rate);
        std::vector<double> impacts(count), sweep(count), burst(count);
        for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(8.0 * seconds); ++i)
            add_impact(impacts, rate, seconds * random.uniform(2 * i), 20.0 * (0.5 + random.uniform(2 * i + 1)));
        for (std::size_t i = 0; i < count; ++i) {
            const double t = static_cast<double>(i) / rate;
            // From 8 to 900 Hz, with an acceleration in proportion to the frequency.
            const double slope = std::log(900.0 / 8.0) / seconds;
            sweep[i] = std::exp(slope * t) * std::sin(2.0 * pi * 8.0 / slope * (std::exp(slope * t) - 1.0));
            const double since = t - 0.7 * seconds;
            burst[i] =
                since > 0.0 && since < 0.35 ? std::pow(std::sin(pi * since / 0.35), 2) * std::sin(340.0 * t) : 0.0;
        }
        CHECK(velocity(impacts, rate) == Approx(integrated(impacts, rate)).epsilon(0.1));
        CHECK(velocity(sweep, rate) == Approx(integrated(sweep, rate)).epsilon(0.1));
        CHECK(velocity(burst, rate) == Approx(integrated(burst, rate)).epsilon(0.07));
    }
}

TEST_CASE("velocity in a band of noise is that of its density") {
    constexpr double rate = 4000.0;
    const Random random(5);
    std::vector<double> x(static_cast<std::size_t>(400.0 * rate));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = random.normal(i);
    // Density 2/rate: the integral of 2/rate/(2 pi f)^2 from 10 to 1000 Hz.
    const double expected = std::sqrt(2.0 / rate / (4.0 * pi * pi) * (1.0 / 10.0 - 1.0 / 1000.0));
    CHECK(velocity(x, rate) == Approx(expected).epsilon(0.03));
}

TEST_CASE("no section of a velocity spans a gap, short pieces count, and the covered part is known") {
    constexpr double rate = 4000.0;
    const std::vector<double> first = sine(100.0, rate, 10.0);
    // A step of phase at a gap would be a click.
    std::vector<double> second = first;
    for (double& value : second) value = -value;
    signal::BandVelocity band(10.0, 1000.0, rate);
    for (const std::vector<double>* const piece : {&first, &std::as_const(second)}) {
        band.push(*piece);
        band.end_piece();
    }
    CHECK(band.rms() == Approx(1.0 / (2.0 * pi * 100.0)).epsilon(1e-3));
    CHECK(band.coverage() == Approx(9.75 / 10.0).margin(1e-3));

    // Pieces of 0.45 s, of which the second half has twice the level.
    signal::BandVelocity pieces(10.0, 1000.0, rate);
    for (int i = 0; i < 10; ++i) {
        std::vector<double> piece(first.begin(), first.begin() + 1800);
        if (i >= 5)
            for (double& value : piece) value *= 2.0;
        pieces.push(piece);
        pieces.end_piece();
    }
    CHECK(pieces.is_resolved());
    CHECK(pieces.rms() == Approx(std::sqrt(2.5) / (2.0 * pi * 100.0)).epsilon(0.01));
    CHECK(pieces.coverage() == Approx(0.2 / 0.45).margin(1e-2));

    signal::BandVelocity short_record(10.0, 1000.0, rate);
    short_record.push(std::span(first).first(1500));
    short_record.end_piece();
    CHECK_FALSE(short_record.is_resolved());
    CHECK(short_record.rms() == 0.0);
    CHECK(short_record.coverage() == 0.0);
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/bands.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>
#include <vector>

using namespace tactus;

namespace {

constexpr double rate = 8000.0;
constexpr std::size_t segment = 4096;

struct LeakedBands {
    std::vector<signal::Band> bands;
    double deviation = 0.0;  // of a bin, relative

    explicit LeakedBands(const std::vector<double>& x) {
        signal::WelchSettings settings = signal::WelchSettings::hann(rate, segment, segment / 2);
        const signal::Spectrum spectrum = signal::welch(std::span<const double>(x), settings);
        bands = signal::third_octaves(spectrum);
        signal::estimate_leakage(bands, spectrum);
        deviation = spectrum.relative_deviation();
    }
};

/// A tone in white noise of deviation `noise`.
std::vector<double> tone_in_noise(double hz, double noise, std::uint64_t seed) {
    const Random random{seed};
    std::vector<double> x;
    for (std::size_t i = 0; i < 40 * segment; ++i)
        x.push_back(std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / rate + 1.0) +
                    noise * random.normal(i));
    return x;
}

}  // namespace

TEST_CASE("the level of a band with a tone near its border, or beside it, is within what is stated to leak") {
    int judged = 0, within = 0, leaky = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        const Random place{seed + 500};
        // Within three bins of the border at 281.8 Hz.
        const double hz = 281.838 + 6.0 * (place.uniform(0) - 0.5), noise = std::pow(10.0, -3.5 * place.uniform(1));
        const LeakedBands found(tone_in_noise(hz, noise, seed));
        for (const signal::Band& band : found.bands) {
            if (band.centre < 100.0 || band.centre > 1000.0) continue;
            const double truth =
                (hz >= band.low && hz < band.high ? 0.5 : 0.0) + noise * noise * (band.high - band.low) / (0.5 * rate);
            const double error = std::abs(10.0 * std::log10(band.power / truth));
            const double random = 4.34 * found.deviation / std::sqrt((band.high - band.low) / (1.5 * rate / segment));
            CAPTURE(hz, noise, band.centre, error, band.leakage_db, random);
            ++judged;
            within += error <= 2.0 * std::hypot(random, band.leakage_db) + 0.02;
            leaky += band.leakage_db > 1.0;
            // A band that only the side lobes reach is never stated to be exact.
            if (error > 3.0) CHECK(band.leakage_db > 0.4);
        }
    }
    CAPTURE(judged, within, leaky);
    CHECK(within >= judged * 95 / 100);
    CHECK(leaky > 12);
}

TEST_CASE("white noise and a tone in the middle of a band leak nothing") {
    const Random random{3};
    std::vector<double> x;
    for (std::size_t i = 0; i < 40 * segment; ++i) x.push_back(random.normal(i));
    for (const signal::Band& band : LeakedBands(x).bands) CHECK(band.leakage_db < 1.0);
    for (const signal::Band& band : LeakedBands(tone_in_noise(316.0, 0.1, 1)).bands)
        if (band.centre > 300.0 && band.centre < 330.0) CHECK(band.leakage_db < 0.01);
}

// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/octave_band.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

using namespace tactus;
using signal::OctaveFilter;

namespace {

constexpr double octave_ratio = 1.9952623149688795;  // 10^0.3, IEC 61260-1

double attenuation(const OctaveFilter& filter, double frequency) {
    return -20.0 * std::log10(std::abs(filter.response(frequency)));
}

}  // namespace

TEST_CASE("octave filters have scipy's Butterworth response") {
    // python3 -c "import numpy as np, scipy.signal as s
    // for lo, hi, fs in ((891.25093813, 1122.0184543, 48000.), (22.387211386, 44.668359215, 2000.)):
    //     sos = s.butter(3, [lo, hi], 'bandpass', fs=fs, output='sos')
    //     f = np.array([.25, .5, .9, 1, 1.1, 2, 4])*np.sqrt(lo*hi)
    //     print(abs(s.sosfreqz(sos, f, fs=fs)[1]))"
    struct Case {
        double low, high, rate;
        std::array<double, 7> wanted;
    };
    for (const Case& one : {Case{891.25093813,
                                 1122.0184543,
                                 48000.0,
                                 {2.339742650e-04, 3.652667597e-03, 7.939636047e-01, 1.0, 8.702909045e-01,
                                  3.595632976e-03, 2.183589588e-04}},
                            Case{22.387211386,
                                 44.668359215,
                                 2000.0,
                                 {6.647810028e-03, 1.032377721e-01, 9.996349931e-01, 1.0, 9.998047976e-01,
                                  1.025021622e-01, 6.398133358e-03}}}) {
        const OctaveFilter filter(one.low, one.high, one.rate);
        constexpr std::array at{0.25, 0.5, 0.9, 1.0, 1.1, 2.0, 4.0};
        for (std::size_t i = 0; i < at.size(); ++i)
            CHECK(std::abs(filter.response(at[i] * std::sqrt(one.low * one.high))) ==
                  Approx(one.wanted[i]).epsilon(1e-4));
    }
}

TEST_CASE("octave and third-octave filters meet class 1 of IEC 61260-1 in every band that the bank has") {
    // Exponents of the octave ratio, and limits of the attenuation in dB: table 1 of the standard.
    constexpr std::array<std::pair<double, double>, 5> greatest{
        {{0.0, 0.4}, {0.125, 0.5}, {0.25, 0.7}, {0.375, 1.4}, {0.4999, 5.3}}};
    constexpr std::array<std::pair<double, double>, 5> least{
        {{0.5001, 1.2}, {1.0, 16.6}, {2.0, 40.5}, {3.0, 60.0}, {4.0, 70.0}}};
    int bands = 0;
    for (const int per_octave : {1, 3})
        for (const double rate : {1000.0, 8000.0, 48000.0})
            for (const signal::FilteredBand& band : signal::OctaveBank(per_octave, rate, 1U << 23).bands()) {
                const OctaveFilter filter(band.low, band.high, rate);
                const double half = std::pow(octave_ratio, 0.5 / per_octave);
                CHECK(band.high / band.centre == Approx(half));
                // Of a third octave the frequencies are nearer to the centre (5.10.3).
                const auto place = [&](double exponent, double sign) {
                    const double omega =
                        1.0 + (half - 1.0) / (std::sqrt(octave_ratio) - 1.0) * (std::pow(octave_ratio, exponent) - 1.0);
                    return band.centre * std::pow(omega, sign);
                };
                for (const double sign : {1.0, -1.0}) {
                    for (const auto& [exponent, limit] : greatest) {
                        if (place(exponent, sign) >= 0.5 * rate) continue;
                        CAPTURE(per_octave, rate, band.centre, exponent, sign);
                        CHECK(attenuation(filter, place(exponent, sign)) >= -0.4);
                        CHECK(attenuation(filter, place(exponent, sign)) <= limit);
                    }
                    for (const auto& [exponent, limit] : least) {
                        if (place(exponent, sign) >= 0.5 * rate) continue;
                        CAPTURE(per_octave, rate, band.centre, exponent, sign);
                        CHECK(attenuation(filter, place(exponent, sign)) >= limit);
                    }
                }
                ++bands;
            }
    CHECK(bands > 100);
}

TEST_CASE("the bank states the mean square of each band, and how much noise scatters") {
    constexpr double rate = 8000.0;
    const Random random{7};
    std::vector<double> x(160000);
    for (std::size_t i = 0; i < x.size(); ++i)
        x[i] = random.normal(i) + 2.0 * std::sin(2.0 * std::numbers::pi * 31.6227766 * static_cast<double>(i) / rate);
    signal::OctaveBank bank(3, rate, x.size());
    bank.push(std::span(x).first(70000));
    bank.push(std::span(x).subspan(70000));
    for (const signal::FilteredBand& band : bank.bands()) {
        CAPTURE(band.centre);
        // White noise of variance 1 has 1/(rate/2) per Hz; the noise bandwidth of the filter is 1.047 times its width.
        const double noise = 1.047 * (band.high - band.low) / (0.5 * rate);
        const double tone = std::abs(band.centre / 31.6227766 - 1.0) < 0.01 ? 2.0 : 0.0;
        const double level = 10.0 * std::log10(band.power), wanted = 10.0 * std::log10(noise + tone);
        if (std::abs(std::log2(band.centre / 31.6227766)) < 0.9 && tone == 0.0) continue;  // its skirts
        CHECK(std::abs(level - wanted) < 4.0 * band.deviation_db + 0.1);
    }
    CHECK(bank.bands().front().centre == Approx(1.0));
    CHECK_THROWS(signal::OctaveFilter(100.0, 90.0, rate));
    CHECK_THROWS(signal::OctaveBank(3, 0.0, 100));
}

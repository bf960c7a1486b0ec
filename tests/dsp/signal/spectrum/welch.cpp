// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/welch.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/spectrum/cross.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;

namespace {

// Golden numbers: /usr/bin/python3 -c 'import numpy as np, scipy.signal as s; i=np.arange(60.);
// x=np.sin(.3*i)+.5*np.cos(1.7*i+.2)+.01*i; y=np.roll(x,2)+.1*i*np.sin(2.1*i);
// print(s.welch(x,8000.,"hann",16,8), s.welch(x,8000.,"hann",15,7,detrend="linear",scaling="spectrum"),
// s.welch(x,8000.,"hann",15,7,detrend=False,average="median"), s.csd(x,y,8000.,"hann",16,8),
// s.coherence(x,y,8000.,"hann",16,8))'
struct Pair {
    std::vector<double> x, y;
    Pair() {
        for (int i = 0; i < 60; ++i) x.push_back(std::sin(.3 * i) + .5 * std::cos(1.7 * i + .2) + .01 * i);
        for (int i = 0; i < 60; ++i) y.push_back(x[static_cast<std::size_t>(i + 58) % 60] + .1 * i * std::sin(2.1 * i));
    }
};

signal::WelchSettings of(std::size_t segment, signal::Detrend detrend,
                         signal::Scaling scaling = signal::Scaling::density) {
    return {8000.0, segment, segment / 2, signal::WindowKind::hann, detrend, signal::Averaging::mean, scaling};
}

void check_equal(const std::vector<double>& got, const std::vector<double>& wanted, double tolerance) {
    REQUIRE(got.size() == wanted.size());
    const double loudest = *std::max_element(wanted.begin(), wanted.end());
    for (std::size_t k = 0; k < got.size(); ++k) {
        CAPTURE(k, got[k], wanted[k]);
        CHECK(std::abs(got[k] - wanted[k]) <= tolerance * loudest);
    }
}

std::vector<double> white_noise(std::size_t count, std::uint64_t seed) {
    const Random random{seed};
    std::vector<double> x(count);
    for (std::size_t i = 0; i < count; ++i) x[i] = random.normal(i);
    return x;
}

}  // namespace

TEST_CASE("spectra equal scipy's: even and odd segments, each detrend, mean and median") {
    const Pair pair;
    const std::vector<double> even{0.00010905167118137041, 0.00043899285067490744, 7.055378654315487e-05,
                                   1.1504424186879021e-05, 0.00014571349946349395, 9.132576194896373e-05,
                                   1.4069861363540794e-06, 4.90313229455317e-08,   5.998923011179662e-09};
    const std::vector<double> odd_linear{0.07609727170127822,   0.15070113308186325,   0.029945714316704636,
                                         0.02525817387019479,   0.1250011101423713,    0.036872097001742946,
                                         1.631872650057224e-05, 1.3331985845560883e-06};
    const std::vector<double> odd_median{0.0005583170570045499,  0.0007227288704386149,  6.899119196187279e-05,
                                         3.9870805333303546e-05, 0.00019969548161130908, 5.8816316116796816e-05,
                                         2.6966997513754002e-08, 2.0430524451381742e-09};
    check_equal(signal::welch<double>(pair.x, of(16, signal::Detrend::constant)).power, even, 1e-12);
    check_equal(signal::welch<double>(pair.x, of(15, signal::Detrend::linear, signal::Scaling::spectrum)).power,
                odd_linear, 1e-11);
    signal::WelchSettings median = of(15, signal::Detrend::none);
    median.averaging = signal::Averaging::median;
    check_equal(signal::welch<double>(pair.x, median).power, odd_median, 1e-12);

    const std::vector<float> single(pair.x.begin(), pair.x.end());
    check_equal(signal::welch<float>(single, of(16, signal::Detrend::constant)).power, even, 2e-5);
    check_equal(signal::welch<float>(single, of(15, signal::Detrend::linear, signal::Scaling::spectrum)).power,
                odd_linear, 2e-5);
}

TEST_CASE("cross-spectrum and coherence equal scipy's") {
    const Pair pair;
    const std::vector<std::complex<double>> wanted{{5.902468284180859e-05, 0.0},
                                                   {0.0003116986362013387, -0.0002337729189019756},
                                                   {5.806754679340199e-05, -4.1022757944298e-05},
                                                   {-1.1467930497055443e-05, 4.012612986757284e-06},
                                                   {-0.00013434518426991797, 7.0003966311334976e-06},
                                                   {-6.866403644487586e-05, -6.648623108048205e-05},
                                                   {5.89970311933418e-07, -8.60947980663312e-06},
                                                   {-1.8756855251244108e-07, 2.4304715003034975e-07},
                                                   {-3.5329828335947426e-08, 0.0}};
    const signal::CrossSpectra cross = signal::cross_spectra<double>(pair.x, pair.y, of(16, signal::Detrend::constant));
    REQUIRE(cross.xy.size() == wanted.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) CHECK(std::abs(cross.xy[k] - wanted[k]) < 1e-12 * 4e-4);
    check_equal(cross.coherence(),
                {0.5379002528518025, 0.9617324526404673, 0.9809667483165488, 0.6862137730586932, 0.22108212802022165,
                 0.018051970896965377, 0.014310777511964384, 0.027851082488354946, 0.12513648805070549},
                1e-12);
    const auto h1 = cross.h1(), h2 = cross.h2();
    const auto gamma = cross.coherence();
    for (std::size_t k = 0; k < h1.size(); ++k) CHECK(std::abs(h1[k] / h2[k]) == Approx(gamma[k]).epsilon(1e-12));
}

TEST_CASE("a record in pieces of any size has the spectrum of the whole, to the bit") {
    const std::vector<double> x = white_noise(40'000, 3), y = white_noise(40'000, 4);
    for (const signal::Averaging averaging :
         {signal::Averaging::mean, signal::Averaging::median, signal::Averaging::maximum, signal::Averaging::minimum}) {
        signal::WelchSettings settings = of(256, signal::Detrend::constant);
        settings.overlap = 100;
        settings.averaging = averaging;
        const signal::Spectrum whole = signal::welch<double>(x, settings);
        signal::WelchStream<double> stream(settings);
        std::size_t piece = 1;
        for (std::size_t at = 0; at < x.size(); at += piece, piece = piece * 5 % 1013 + 1)
            stream.push(std::span(x).subspan(at, std::min(piece, x.size() - at)));
        const signal::Spectrum pieces = stream.spectrum();
        CHECK(pieces.segments == whole.segments);
        CHECK(pieces.power == whole.power);
        // Work spread over threads runs in any order.
        const auto backwards = [](std::size_t count, const std::function<void(std::size_t)>& run) {
            while (count-- > 0) run(count);
        };
        CHECK(signal::welch<double>(x, settings, backwards).power == whole.power);
    }
    signal::CrossStream<double> stream(of(256, signal::Detrend::linear));
    for (std::size_t at = 0; at < x.size(); at += 777) {
        const std::size_t count = std::min<std::size_t>(777, x.size() - at);
        stream.push(std::span(x).subspan(at, count), std::span(y).subspan(at, count));
    }
    CHECK(stream.spectra().xy == signal::cross_spectra<double>(x, y, of(256, signal::Detrend::linear)).xy);
}

TEST_CASE("the power of noise is its variance, spread over the band, and the scatter is what is promised") {
    const std::vector<double> x = white_noise(200'000, 5);
    const signal::Spectrum spectrum = signal::welch<double>(x, of(512, signal::Detrend::constant));
    double total = 0.0, scatter = 0.0;
    for (const double p : spectrum.power) total += p * spectrum.df;
    CHECK(total == Approx(1.0).epsilon(0.01));
    for (std::size_t k = 1; k + 1 < spectrum.power.size(); ++k)
        scatter += std::pow(spectrum.power[k] * 4000.0 - 1.0, 2.0) / 255.0;
    CHECK(spectrum.relative_deviation() ==
          Approx(std::sqrt(19.0 / 18.0 / static_cast<double>(spectrum.segments))).epsilon(1e-3));
    CHECK(std::sqrt(scatter) == Approx(spectrum.relative_deviation()).epsilon(0.15));
    CHECK(spectrum.noise_bandwidth == Approx(1.5 * 8000.0 / 512.0).epsilon(1e-12));
}

TEST_CASE("a tone on a bin reads half its squared amplitude, at 0 Hz and half the rate the whole") {
    std::vector<double> x(4096);
    for (const auto& [bin, wanted] : {std::pair{0, 9.0}, {20, 4.5}, {64, 9.0}}) {
        for (std::size_t i = 0; i < x.size(); ++i)
            x[i] = 3.0 * std::cos(std::numbers::pi * bin * static_cast<double>(i) / 64.0);
        const signal::Spectrum spectrum =
            signal::welch<double>(x, of(128, signal::Detrend::none, signal::Scaling::spectrum));
        CHECK(spectrum.power[static_cast<std::size_t>(bin)] == Approx(wanted).epsilon(1e-12));
    }
}

TEST_CASE("unrelated noise has coherence near one over the number of segments, and too few are refused") {
    const std::vector<double> x = white_noise(100'000, 6), y = white_noise(100'000, 7);
    signal::WelchSettings settings = of(1000, signal::Detrend::constant);
    settings.overlap = 0;
    const auto gamma = signal::cross_spectra<double>(x, y, settings).coherence();
    double mean = 0.0;
    for (const double g : gamma) mean += g / static_cast<double>(gamma.size());
    CHECK(mean == Approx(0.01).epsilon(0.2));
    settings.segment = 30'000;
    CHECK_THROWS_WITH(signal::cross_spectra<double>(x, y, settings).coherence(),
                      Catch::Matchers::ContainsSubstring("at least 4 segments"));
}

TEST_CASE("H1 finds a filter under noise on its output") {
    std::vector<double> x = white_noise(400'000, 8), y = white_noise(400'000, 9);
    for (std::size_t i = 1; i < x.size(); ++i) y[i] = x[i] + 0.5 * x[i - 1] + 0.3 * y[i];
    const signal::CrossSpectra cross = signal::cross_spectra<double>(x, y, of(256, signal::Detrend::constant));
    const auto h = cross.h1();
    const auto deviation = cross.response_deviation();
    for (std::size_t k = 4; k < 124; ++k) {
        const auto wanted = 1.0 + 0.5 * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) / 256.0);
        CHECK(std::abs(h[k] - wanted) < 6.0 * deviation[k] * std::abs(wanted));
    }
}

TEST_CASE("the median of a long record stays in bounded memory and near the truth") {
    signal::WelchSettings settings = of(16, signal::Detrend::none);
    settings.averaging = signal::Averaging::median;
    signal::WelchStream<double> stream(settings);
    const std::vector<double> x = white_noise(100'000, 10);
    stream.push(x);
    const signal::Spectrum spectrum = stream.spectrum();
    CHECK(spectrum.segments > 12'000);
    for (std::size_t k = 1; k < 8; ++k)
        CHECK(spectrum.power[k] * 4000.0 == Approx(1.0).epsilon(5.0 * spectrum.relative_deviation()));
    CHECK(spectrum.relative_deviation() < 0.07);
}

TEST_CASE("settings that make no sense are refused, short records are one segment") {
    CHECK_THROWS_AS(signal::WelchStream<double>({8000.0, 0, 0}), Error);
    CHECK_THROWS_AS(signal::WelchStream<double>({8000.0, 16, 16}), Error);
    CHECK_THROWS_AS(signal::WelchStream<double>({0.0, 16, 8}), Error);
    CHECK(signal::welch<double>({}, of(16, signal::Detrend::none)).power.empty());
    const std::vector<double> one{2.0};
    CHECK(signal::welch<double>(one, of(16, signal::Detrend::none)).segments == 1);
}

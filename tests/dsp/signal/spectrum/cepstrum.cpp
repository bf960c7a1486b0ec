// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/cepstrum.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

using namespace tactus;

TEST_CASE("the cepstrum of a spectrum is the inverse transform of its logarithm, as numpy's") {
    // python3 -c "import numpy as np; k = np.arange(129); w = 2*np.pi*k/256
    // c = np.fft.irfft(2*np.cos(16*w) + .5*np.cos(32*w) - .5*np.log(1 + k)); print(c[[0, 1, 2, 16, 32, 100]])"
    signal::Spectrum spectrum;
    spectrum.df = 4.0;
    for (int k = 0; k < 129; ++k) {
        const double w = 2.0 * std::numbers::pi * k / 256.0;
        spectrum.power.push_back(std::exp(2.0 * std::cos(16.0 * w) + 0.5 * std::cos(32.0 * w)) / std::sqrt(1.0 + k));
    }
    const signal::Cepstrum cepstrum = signal::real_cepstrum(spectrum);
    CHECK(cepstrum.step == Approx(1.0 / 1024.0));
    for (const auto& [k, wanted] : std::initializer_list<std::pair<std::size_t, double>>{{0, -1.9485757214429629},
                                                                                         {1, 0.2785716281869839},
                                                                                         {2, 0.0996851748707296},
                                                                                         {16, 1.009470967825406},
                                                                                         {32, 0.25378102399339214},
                                                                                         {100, 0.0009635952222472473}})
        CHECK(cepstrum.value[k] == Approx(wanted).margin(1e-12));
}

TEST_CASE("a family of side bands in noise is one peak at the reciprocal of its spacing, and noise has none") {
    constexpr double rate = 8000.0, spacing = 31.25;
    const Random random{3};
    std::vector<double> noise(160000), family;
    for (std::size_t i = 0; i < noise.size(); ++i) {
        noise[i] = random.normal(i);
        double x = noise[i];
        for (int k = -15; k <= 15; ++k)
            x += 0.12 *
                 std::sin(2.0 * std::numbers::pi * (1700.0 + k * spacing) * static_cast<double>(i) / rate + k * k);
        family.push_back(x);
    }
    const auto peaks = [&](const std::vector<double>& x) {
        return signal::cepstral_peaks(
            signal::real_cepstrum(signal::welch<double>(x, signal::WelchSettings::hann(rate, 4096, 2048))), 3);
    };
    REQUIRE(!peaks(family).empty());
    CHECK(peaks(family).front().frequency() == Approx(spacing).epsilon(0.005));
    CHECK(peaks(noise).size() <= 1);
    CHECK(signal::cepstral_peaks(signal::real_cepstrum({}), 3).empty());
}

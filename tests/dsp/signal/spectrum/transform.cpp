// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/transform.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numbers>

using namespace tactus;

TEST_CASE("a spectrum is the sum over the samples, and goes back to them") {
    const Random random{1};
    for (const std::size_t size : {2u, 6u, 64u, 170u, 1024u}) {
        std::vector<double> samples(size - size / 3);
        for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = random.normal(i);
        const auto spectrum = signal::spectrum_of(samples, size);
        REQUIRE(spectrum.size() == size / 2 + 1);
        for (std::size_t k = 0; k < spectrum.size(); ++k) {
            std::complex<double> sum = 0.0;
            for (std::size_t i = 0; i < samples.size(); ++i)
                sum += std::polar(samples[i], -2.0 * std::numbers::pi * static_cast<double>(k * i % size) /
                                                  static_cast<double>(size));
            CHECK(std::abs(spectrum[k] - sum) < 1e-11);
        }
        const std::vector<double> back = signal::samples_of(spectrum);
        REQUIRE(back.size() == size);
        for (std::size_t i = 0; i < size; ++i)
            CHECK(back[i] == Approx(i < samples.size() ? samples[i] : 0.0).margin(1e-13));
    }
}

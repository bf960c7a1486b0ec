// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/line_match.hpp"

#include "tests/dsp/vibration/plant.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

namespace {

constexpr double rate = 8000.0;

signal::Spectrum spectrum_of_tones(std::initializer_list<std::pair<double, double>> tones, double noise,
                                   std::uint64_t seed) {
    std::vector<double> samples(80000);
    const Random random{seed};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] = noise * random.normal(i);
        for (const auto& [hz, amplitude] : tones)
            samples[i] += amplitude * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / rate);
    }
    signal::WelchSettings settings;
    settings.rate = rate;
    settings.segment = 8192;
    settings.overlap = 4096;
    return signal::welch<double>(samples, settings);
}

}  // namespace

TEST_CASE("the harmonic error is the worst order's deviation from the mean gain") {
    const signal::Spectrum reference = spectrum_of_tones({{200.0, 1.0}, {400.0, 0.5}, {600.0, 0.2}}, 1e-3, 1);
    // gains of 0, 6.02 and 0 dB: mean 2.007 dB, worst deviation 4.013 dB
    const signal::Spectrum output = spectrum_of_tones({{201.0, 1.0}, {402.0, 1.0}, {603.0, 0.2}}, 1e-3, 2);
    const auto error = signal::harmonic_error(reference, 200.0, output, 201.0, 1000.0);
    REQUIRE(error.has_value());
    CHECK(*error == Approx(4.0137).margin(0.02));
    CHECK_FALSE(signal::harmonic_error(reference, 0.0, output, 201.0, 1000.0).has_value());
    CHECK_FALSE(signal::harmonic_error(reference, 200.0, output, 201.0, 300.0).has_value());
}

TEST_CASE("orders 40 dB below the strongest are residue and no part of the harmonic error") {
    const signal::Spectrum reference = spectrum_of_tones({{200.0, 1.0}, {400.0, 0.5}, {600.0, 0.003}}, 1e-6, 1);
    const signal::Spectrum output = spectrum_of_tones({{200.0, 1.0}, {400.0, 0.5}, {600.0, 0.0001}}, 1e-6, 2);
    CHECK(signal::harmonic_error(reference, 200.0, output, 200.0, 1000.0).value() < 0.01);
}

TEST_CASE("lines match at equal speed, and a line that is there but soft is missing") {
    const signal::Spectrum reference = spectrum_of_tones({{200.0, 1.0}, {400.0, 0.5}, {600.0, 0.2}}, 1e-3, 1);
    const signal::Spectrum output = spectrum_of_tones({{204.0, 0.1}, {408.0, 0.05}, {50.0, 0.01}}, 1e-4, 2);
    const signal::MatchedLines matched = signal::match_lines(reference, output, 10.0, 1.02, 40.0, 1000.0);
    CHECK(matched.in_both.size() == 2);
    REQUIRE(matched.only_in_reference.size() == 1);
    CHECK(matched.only_in_reference[0].frequency == Approx(600.0).margin(0.02));
    REQUIRE(matched.only_in_output.size() == 1);
    CHECK(matched.only_in_output[0].frequency == Approx(50.0).margin(0.02));
}

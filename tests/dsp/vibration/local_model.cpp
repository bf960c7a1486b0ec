// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/local_model.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/vibration/identify.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;

namespace {

/// Acceleration per force of a resonator of unit mass, with a constant beside it.
std::complex<double> resonator(double f, double f0, double damping, double direct) {
    const std::complex<double> s(0.0, f / f0);
    return direct + s * s / (s * s + 2.0 * damping * s + 1.0);
}

std::vector<vibration::ResponseBin> bins_of(double f0, double damping, double noise, double step, double width) {
    const Random random{5};
    std::vector<vibration::ResponseBin> bins;
    std::uint64_t drawn = 0;
    for (double f = f0 - width; f <= f0 + width; f += step) {
        const std::complex<double> e(random.normal(drawn), random.normal(drawn + 1));
        drawn += 2;
        bins.push_back({f, resonator(f, f0, damping, 0.3) + noise * e, 1.0});
    }
    return bins;
}

constexpr double rate = 6000.0;

/// A resonator driven by a sweep, in samples.
std::vector<float> answer(const vibration::SweepRun& run, double f0, double damping, double noise_rms) {
    const Random random{11};
    const double r = std::exp(-damping * 2.0 * pi * f0 / rate),
                 w = std::sqrt(1.0 - damping * damping) * 2.0 * pi * f0 / rate;
    std::vector<float> out;
    double y1 = 0.0, y2 = 0.0, before = 0.0;
    const auto count = static_cast<std::size_t>((run.sweep.duration + run.pause) * rate);
    for (std::size_t i = 0; i < count; ++i) {
        const double x = run.sweep(static_cast<double>(i) / rate);
        const double y = 2.0 * r * std::cos(w) * y1 - r * r * y2 + 0.01 * before;
        y2 = y1, y1 = y, before = x;
        out.push_back(static_cast<float>(y + noise_rms * random.normal(i)));
    }
    return out;
}

double gain_of(double f, double f0, double damping) {
    const double r = std::exp(-damping * 2.0 * pi * f0 / rate),
                 w = std::sqrt(1.0 - damping * damping) * 2.0 * pi * f0 / rate;
    const std::complex<double> z = std::polar(1.0, -2.0 * pi * f / rate);
    return std::abs(0.01 * z / (1.0 - 2.0 * r * std::cos(w) * z + r * r * z * z));
}

}  // namespace

TEST_CASE("a local model has the frequency and damping of a resonance that only a few bins cross") {
    for (const double damping : {0.02, 0.005, 0.0025}) {
        const auto bins = bins_of(100.0, damping, 0.0, 0.11, 2.5);
        const vibration::LocalModel model = vibration::fit_local_model(bins, 100.0, 2.5);
        CAPTURE(damping);
        REQUIRE(model.is_significant());
        CHECK(model.frequency() == Approx(100.0).epsilon(1e-4));
        CHECK(model.damping() == Approx(damping).epsilon(0.005));
        CHECK(std::abs(model(100.0)) == Approx(std::abs(resonator(100.0, 100.0, damping, 0.3))).epsilon(0.002));
    }
}

TEST_CASE("the stated deviation of a pole is that of its error, and noise alone has no pole") {
    const Random random{2};
    double square = 0.0, stated = 0.0;
    int poles = 0;
    for (int run = 0; run < 200; ++run) {
        std::vector<vibration::ResponseBin> noisy = bins_of(100.0, 0.01, 0.0, 0.1, 3.0), empty = noisy;
        for (std::size_t i = 0; i < noisy.size(); ++i) {
            const auto at = static_cast<std::uint64_t>(run) * 1000 + 2 * i;
            const std::complex<double> e(random.normal(at), random.normal(at + 1));
            noisy[i].gain += 2.0 * e;
            empty[i].gain = 1.0 + 0.3 * e;
        }
        const vibration::LocalModel model = vibration::fit_local_model(noisy, 100.0, 3.0);
        square += std::pow(model.pole().imag() - 1.0, 2.0);
        stated += model.pole_deviation;
        poles += vibration::fit_local_model(empty, 100.0, 3.0).is_significant();
    }
    CHECK(std::sqrt(square / 200.0) == Approx(stated / 200.0).epsilon(0.25));
    CHECK(poles == 0);
}

TEST_CASE("a sweep finds the damping and the peak of a resonance of Q 100, and states what Q 200 needs") {
    const vibration::SweepRun run{{20.0, 2000.0, 8.0, 0.02}, 1.0, 1.0, 1};
    const vibration::Identified found = vibration::identify(run, answer(run, 150.0, 0.005, 1e-4), rate);
    REQUIRE(found.modes.size() == 1);
    CHECK(found.modes[0].hz == Approx(150.0).epsilon(1e-3));
    CHECK(found.modes[0].damping == Approx(0.005).epsilon(0.05));
    CHECK(found.modes[0].is_resolved());
    double peak = 0.0;
    for (const std::complex<double>& gain : found.response.gain) peak = std::max(peak, std::abs(gain));
    CHECK(std::abs(20.0 * std::log10(peak / gain_of(150.0, 150.0, 0.005))) < 0.25);
    CHECK(std::is_sorted(found.response.hz.begin(), found.response.hz.end()));
    // A short sweep ends before the ringing does.
    const vibration::SweepRun brief{{20.0, 2000.0, 1.0, 0.02}, 1.0, 0.1, 1};
    const vibration::Identified cut = vibration::identify(brief, answer(brief, 60.0, 0.0025, 1e-6), rate);
    for (const vibration::Mode& mode : cut.modes) {
        CHECK_FALSE(mode.is_resolved());
        CHECK(mode.needed_duration > 2.0);
    }
}

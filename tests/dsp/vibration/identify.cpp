// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/identify.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/dsp/vibration/plant.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double sweep_rate = 48000.0;

std::vector<float> drive_of(const vibration::SweepRun& run) {
    const auto period = static_cast<std::size_t>((run.sweep.duration + run.pause) * sweep_rate);
    std::vector<float> samples;
    for (int r = 0; r < run.repeats; ++r)
        for (std::size_t i = 0; i < period; ++i)
            samples.push_back(static_cast<float>(run.amplitude * run.sweep(static_cast<double>(i) / sweep_rate)));
    return samples;
}

std::vector<float> delayed(const std::vector<float>& samples, std::size_t count) {
    std::vector<float> out(samples.size(), 0.0f);
    std::copy(samples.begin(), samples.end() - static_cast<std::ptrdiff_t>(count),
              out.begin() + static_cast<std::ptrdiff_t>(count));
    return out;
}

double sweep_decibel(double ratio) { return 20.0 * std::log10(ratio); }

/// Largest deviation of level from the plant's within the band, dB.
double level_error(const vibration::FrequencyResponse& response, const std::function<double(double)>& truth,
                   double lowest, double highest) {
    double worst = 0.0;
    for (std::size_t i = 0; i < response.hz.size(); ++i)
        if (response.hz[i] >= lowest && response.hz[i] <= highest)
            worst = std::max(worst, std::abs(sweep_decibel(std::abs(response.gain[i]) / truth(response.hz[i]))));
    return worst;
}

}  // namespace

TEST_CASE("a sweep passes each octave in the same time and ends where it should") {
    const vibration::ExponentialSweep sweep{20.0, 2000.0, 8.0, 0.02};
    // Between two upward zero crossings lies one period of the frequency in the middle.
    const auto frequency = [&](double t) {
        double before = t;
        while (!(sweep(before) <= 0.0 && sweep(before + 1e-6) > 0.0)) before += 1e-6;
        double after = before + 2e-6;
        while (!(sweep(after) <= 0.0 && sweep(after + 1e-6) > 0.0)) after += 1e-6;
        return std::pair(0.5 * (before + after), 1.0 / (after - before));
    };
    for (const double t : {1.0, 3.0, 5.0, 7.0}) {
        const auto [middle, hz] = frequency(t);
        CHECK(hz == Approx(20.0 * std::pow(100.0, middle / 8.0)).epsilon(0.003));
    }
    CHECK(sweep.lead(2) == Approx(8.0 * std::log(2.0) / std::log(100.0)));
    CHECK(sweep(-0.001) == 0.0);
    CHECK(sweep(8.001) == 0.0);
}

TEST_CASE("a sweep identifies a plant within 0.25 dB from 40 to 1000 Hz through hum and noise") {
    const vibration::SweepRun run{{20.0, 2000.0, 8.0, 0.02}, 1.0, 1.0, 1};
    const test::Plant plant;
    std::vector<float> heard = plant(drive_of(run));
    test::add_disturbance(heard, sweep_rate, -50.0, -80.0, 3);
    const vibration::FrequencyResponse response = vibration::identify(run, heard, sweep_rate).response;
    const auto truth = [&](double f) { return std::abs(plant.gain(f)); };
    CHECK(level_error(response, truth, 40.0, 1000.0) < 0.25);
    CHECK(response.latency == Approx(0.0).margin(5e-5));
    for (std::size_t i = 0; i < response.hz.size(); ++i) {
        if (response.hz[i] < 60.0 || response.hz[i] > 1000.0) continue;
        CHECK(response.coherence[i] > 0.99);
        const std::complex<double> whole =
            response.gain[i] * std::polar(1.0, -2.0 * std::numbers::pi * response.hz[i] * response.latency);
        CHECK(std::arg(whole / plant.gain(response.hz[i])) == Approx(0.0).margin(0.01));
    }
}

TEST_CASE("latency is the delay of the chain, not the phase of its resonance") {
    const vibration::SweepRun run{{20.0, 2000.0, 4.0, 0.02}, 0.5, 0.5, 1};
    for (const std::size_t samples : {0u, 37u, 128u, 4800u}) {
        const vibration::FrequencyResponse response =
            vibration::identify(run, delayed(test::Plant{}(drive_of(run)), samples), sweep_rate).response;
        CHECK(response.latency == Approx(static_cast<double>(samples) / sweep_rate).margin(5e-5));
    }
}

TEST_CASE("distortion comes out by order: 1.0375, 0.05 and 0.0125 of x + 0.1 x² + 0.05 x³") {
    const vibration::SweepRun run{{20.0, 2000.0, 8.0, 0.02}, 1.0, 1.0, 1};
    std::vector<float> heard = drive_of(run);
    for (float& x : heard) x = x + 0.1f * x * x + 0.05f * x * x * x;
    const vibration::Identified found = vibration::identify(run, heard, sweep_rate, 4);
    for (std::size_t i = 0; i < found.response.hz.size(); ++i) {
        const double f = found.response.hz[i];
        if (f < 40.0 || f > 490.0) continue;
        INFO(f << " Hz");
        CHECK(std::abs(found.response.gain[i]) == Approx(1.0375).epsilon(0.002));
        CHECK(found.distortions[0].ratio[i] * 1.0375 == Approx(0.05).epsilon(0.02));
        CHECK(found.distortions[1].ratio[i] * 1.0375 == Approx(0.0125).epsilon(0.02));
        CHECK(found.distortions[2].ratio[i] < 1e-3);
    }
}

TEST_CASE("noise that does not repeat lowers the coherence where it is, and only there") {
    const vibration::SweepRun run{{20.0, 2000.0, 4.0, 0.02}, 1.0, 0.5, 2};
    std::vector<float> heard = test::Plant{}(drive_of(run));
    const Random random{9};
    signal::Biquad around{signal::bandpass(300.0, sweep_rate, 3.0)};
    for (std::size_t i = 0; i < heard.size(); ++i) heard[i] += static_cast<float>(around(30.0 * random.normal(i)));
    const vibration::FrequencyResponse response = vibration::identify(run, heard, sweep_rate).response;
    for (std::size_t i = 0; i < response.hz.size(); ++i) {
        if (std::abs(response.hz[i] - 300.0) < 20.0) CHECK(response.coherence[i] < 0.8);
        if (response.hz[i] > 60.0 && response.hz[i] < 90.0) CHECK(response.coherence[i] > 0.85);
    }
}

TEST_CASE("the fitted resonance is the actuator's, whatever modes the handle adds and whatever the sensor measures") {
    const vibration::SweepRun run{{20.0, 2000.0, 8.0, 0.02}, 1.0, 1.0, 1};
    const auto fit = [&](const std::vector<float>& heard) {
        return vibration::fit_resonance(vibration::identify(run, heard, sweep_rate).response, 30.0, 400.0);
    };
    const vibration::Resonance handle = fit(test::Plant{}(drive_of(run)));
    CHECK(handle.hz == Approx(75.0).epsilon(0.06));
    CHECK(handle.damping == Approx(0.25).epsilon(0.2));
    CHECK(handle.order == 2);

    std::vector<float> alone = drive_of(run), displacement = alone;
    signal::Biquad resonator{signal::highpass(89.0, sweep_rate, 1.0 / 0.46)},
        spring{signal::lowpass(60.0, sweep_rate, 2.0)};
    for (float& x : alone) x = static_cast<float>(resonator(static_cast<double>(x)));
    for (float& x : displacement) x = static_cast<float>(spring(static_cast<double>(x)));
    const vibration::Resonance bare = fit(alone);
    CHECK(bare.hz == Approx(89.0).epsilon(0.002));
    CHECK(bare.damping == Approx(0.23).epsilon(0.005));
    CHECK(bare.error_db < 0.05);
    const vibration::Resonance moved = fit(displacement);
    CHECK(moved.order == 0);
    CHECK(moved.hz == Approx(60.0).epsilon(0.002));
    CHECK(moved.damping == Approx(0.25).epsilon(0.005));
}

TEST_CASE("a straight wire and a mere slope have no resonance") {
    const vibration::SweepRun run{{20.0, 2000.0, 2.0, 0.02}, 1.0, 0.5, 1};
    CHECK(vibration::fit_resonance(vibration::identify(run, drive_of(run), sweep_rate).response, 30.0, 400.0).hz ==
          0.0);
    vibration::FrequencyResponse slope;
    for (double f = 20.0; f < 500.0; f *= 1.02) {
        slope.hz.push_back(f);
        slope.gain.push_back(f * f);
    }
    CHECK(vibration::fit_resonance(slope, 30.0, 400.0).hz == 0.0);
    CHECK_THROWS_WITH(vibration::fit_resonance(slope, 30.0, 31.0), ContainsSubstring("8 frequencies"));
}

TEST_CASE("minimum phase follows from the level alone") {
    const test::Plant plant;
    std::vector<double> hz, magnitude;
    for (double f = 15.0; f < 3000.0; f *= std::exp2(1.0 / 48.0)) {
        hz.push_back(f);
        magnitude.push_back(std::abs(plant.gain(f)));
    }
    const std::vector<double> phase = vibration::minimum_phase(hz, magnitude);
    for (std::size_t i = 0; i < hz.size(); ++i)
        if (hz[i] > 30.0 && hz[i] < 1000.0)
            CHECK(std::remainder(phase[i] - std::arg(plant.gain(hz[i])), 2.0 * std::numbers::pi) ==
                  Approx(0.0).margin(0.03));
}

TEST_CASE("a damping that noise hides is stated to need a longer sweep, one that is claimed is right", "[slow]") {
    const vibration::SweepRun run{{20.0, 1000.0, 8.0, 0.02}, 1.0, 1.0, 1};
    constexpr double rate = 4000.0;
    int claimed = 0, longer = 0;
    for (const double snr_db : {40.0, 0.0})
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            const Random random{seed * 31 + 7};
            const double f0 = 80.0 + 60.0 * static_cast<double>(seed),
                         damping = 0.06 + 0.008 * static_cast<double>(seed);
            const double angle = 2.0 * std::numbers::pi * f0 / rate, r = std::exp(-damping * angle);
            const double a1 = 2.0 * r * std::cos(std::sqrt(1.0 - damping * damping) * angle);
            std::vector<double> y(static_cast<std::size_t>(9.0 * rate));
            double y1 = 0.0, y2 = 0.0, square = 0.0;
            for (std::size_t i = 0; i < y.size(); ++i) {
                y[i] = run.sweep(static_cast<double>(i) / rate) * angle * angle + a1 * y1 - r * r * y2;
                y2 = y1, y1 = y[i];
                square += y[i] * y[i];
            }
            const double noise = std::sqrt(square / static_cast<double>(y.size())) * std::pow(10.0, -snr_db / 20.0);
            std::vector<float> heard;
            for (std::size_t i = 0; i < y.size(); ++i)
                heard.push_back(static_cast<float>(y[i] + noise * random.normal(i)));
            for (const vibration::Mode& mode : vibration::identify(run, heard, rate, 2, 12).modes) {
                if (std::abs(mode.hz / f0 - 1.0) > 0.02) continue;
                CAPTURE(snr_db, f0, damping, mode.damping, mode.deviation);
                if (mode.is_resolved()) CHECK(mode.damping == Approx(damping).epsilon(0.05));
                else CHECK(mode.needed_duration > 8.0);
                (mode.is_resolved() ? claimed : longer) += snr_db > 20.0 || !mode.is_resolved();
            }
        }
    // Without noise all are claimed; in noise most are not.
    CHECK(claimed == 4);
    CHECK(longer >= 2);
}

TEST_CASE("a record without the sweep is refused") {
    const vibration::SweepRun run{{20.0, 2000.0, 1.0, 0.02}, 1.0, 0.5, 1};
    CHECK_THROWS_WITH(vibration::identify(run, std::vector<float>(1000), sweep_rate),
                      ContainsSubstring("0.0208 s long; 1.5 s were played"));
    CHECK_THROWS_WITH(vibration::identify(run, std::vector<float>(72000), sweep_rate), ContainsSubstring("silent"));
    CHECK_THROWS_AS(vibration::identify({{20.0, 30.0, 1.0}, 1.0, 0.5, 1}, std::vector<float>(72000), sweep_rate),
                    Error);
}

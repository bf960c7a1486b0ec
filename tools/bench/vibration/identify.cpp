// SPDX-License-Identifier: Apache-2.0
// Synthetic resonances of known Q behind a sweep: how well 'measure' finds their damping and peak.
#include "dsp/vibration/identify.hpp"
#include "assets/file/json.hpp"
#include "dsp/core/random.hpp"
#include "tools/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace tactus::bench {

namespace {

struct IdentifyChoice {
    int runs = 100, first = 1000;
    double duration = 8.0, snr = 30.0;
    bool json = false;
};

constexpr double identify_rate = 6000.0;

/// A resonance beside a direct path: impulse-invariant poles, exact in the samples.
struct ResonatorCase {
    double frequency, damping, direct;

    ResonatorCase(const Random& random, double low_q, double high_q)
        : frequency(40.0 * std::pow(500.0 / 40.0, random.uniform(0))),
          damping(0.5 / (low_q * std::pow(high_q / low_q, random.uniform(1)))),
          direct(random.uniform(2) - 0.5) {}

    double radius() const { return std::exp(-damping * 2.0 * std::numbers::pi * frequency / identify_rate); }
    double angle() const {
        return std::sqrt(1.0 - damping * damping) * 2.0 * std::numbers::pi * frequency / identify_rate;
    }
    std::complex<double> gain(double f) const {
        const std::complex<double> z = std::polar(1.0, -2.0 * std::numbers::pi * f / identify_rate);
        const double r = radius();
        return direct + z * scale() / (1.0 - 2.0 * r * std::cos(angle()) * z + r * r * z * z);
    }
    /// About 1/(2ζ) at the resonance.
    double scale() const { return std::sin(angle()) * std::sin(angle()); }
    /// Of a sweep, as floats, with noise of this level below the rms of the answer.
    std::vector<float> answer(const vibration::SweepRun& run, double snr_db, const Random& random) const {
        const auto count = static_cast<std::size_t>((run.sweep.duration + run.pause) * identify_rate);
        std::vector<double> y(count);
        const double r = radius(), a1 = 2.0 * r * std::cos(angle()), a2 = r * r;
        double y1 = 0.0, y2 = 0.0, before = 0.0, square = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const double x = run.amplitude * run.sweep(static_cast<double>(i) / identify_rate);
            const double ringing = a1 * y1 - a2 * y2 + scale() * before;
            y2 = y1, y1 = ringing, before = x;
            y[i] = direct * x + ringing;
            square += y[i] * y[i];
        }
        const double noise = std::sqrt(square / static_cast<double>(count)) * std::pow(10.0, -snr_db / 20.0);
        std::vector<float> out;
        for (std::size_t i = 0; i < count; ++i)
            out.push_back(static_cast<float>(y[i] + noise * random.normal(1000 + i)));
        return out;
    }
    double peak() const {
        double greatest = 0.0;
        for (int i = -400; i <= 400; ++i)
            greatest = std::max(greatest, std::abs(gain(frequency * (1.0 + 0.01 * damping * i))));
        return greatest;
    }
};

struct IdentifyRow {
    double low_q, high_q;
    int count = 0, damping = 0, peak = 0, both = 0, missing = 0, unresolved = 0, claimed = 0, claimed_right = 0;
};

int bench_identify(const IdentifyChoice& choice) {
    const vibration::SweepRun run{{20.0, 2000.0, choice.duration, 0.02}, 1.0, 1.0, 1};
    std::array<IdentifyRow, 5> rows{{{5.0, 10.0}, {10.0, 25.0}, {25.0, 50.0}, {50.0, 100.0}, {100.0, 200.0}}};
    for (IdentifyRow& row : rows)
        for (int i = 0; i < choice.runs; ++i) {
            const Random random{static_cast<std::uint64_t>(choice.first + i) * 8191 +
                                static_cast<std::uint64_t>(row.low_q)};
            const ResonatorCase one(random, row.low_q, row.high_q);
            const vibration::Identified found =
                vibration::identify(run, one.answer(run, choice.snr, random), identify_rate);
            ++row.count;
            double peak = 0.0;
            for (std::size_t k = 0; k < found.response.hz.size(); ++k)
                if (std::abs(found.response.hz[k] / one.frequency - 1.0) < 0.1 + 4.0 * one.damping)
                    peak = std::max(peak, std::abs(found.response.gain[k]));
            double damping = 0.0;
            bool resolved = false, has_mode = false;
            for (const vibration::Mode& mode : found.modes)
                if (std::abs(mode.hz / one.frequency - 1.0) < 0.02)
                    damping = mode.damping, resolved = mode.is_resolved(), has_mode = true;
            if (!has_mode) {
                ++row.missing;
                // As 'measure' does.
                const vibration::Resonance fit = vibration::fit_resonance(found.response, 30.0, 600.0);
                if (fit.hz > 0.0) damping = fit.damping;
            }
            const bool damping_right = std::abs(damping / one.damping - 1.0) <= 0.05;
            const bool peak_right = std::abs(20.0 * std::log10(peak / one.peak())) <= 0.25;
            row.damping += damping_right;
            row.peak += peak_right;
            row.both += damping_right && peak_right;
            row.unresolved += has_mode && !resolved;
            row.claimed += resolved;
            row.claimed_right += resolved && damping_right && peak_right;
        }
    if (choice.json) {
        file::Json json = file::Json::array();
        for (const IdentifyRow& row : rows)
            json.push_back({{"q", {row.low_q, row.high_q}},
                            {"runs", row.count},
                            {"damping_within_5_percent", row.damping},
                            {"peak_within_quarter_db", row.peak},
                            {"both", row.both},
                            {"without_mode", row.missing},
                            {"needs_longer", row.unresolved},
                            {"claimed", row.claimed},
                            {"claimed_right", row.claimed_right}});
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print("{:>10} {:>6} {:>14} {:>14} {:>8} {:>10} {:>12} {:>16}\n", "Q", "runs", "damping, 5 %", "peak, 0.25 dB",
               "both", "no mode", "needs longer", "right of the rest");
    for (const IdentifyRow& row : rows)
        fmt::print("{:>4.0f} to {:<3.0f} {:>5} {:>14} {:>14} {:>8} {:>10} {:>12} {:>9} of {}\n", row.low_q, row.high_q,
                   row.count, row.damping, row.peak, row.both, row.missing, row.unresolved, row.claimed_right,
                   row.claimed);
    return done;
}

}  // namespace

Verb identify_verb() {
    return {
        "identify",
        "synthetic resonances of 40 to 500 Hz behind a sweep: how many have a damping within 5 % and a peak within "
        "0.25 dB",
        [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<IdentifyChoice>();
            verb.add("--runs", choice->runs, "resonances of each range of Q").shows_default().range(1, 1000000);
            verb.add("--first", choice->first, "seed of the first").shows_default().range(0, 1000000000);
            verb.add("--duration", choice->duration, "of the sweep, s").unit("s").shows_default().range(0.5, 1e3);
            verb.add("--snr", choice->snr, "rms of the answer over the noise, dB").shows_default().range(-20.0, 200.0);
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_identify(*choice); };
        }};
}

}  // namespace tactus::bench

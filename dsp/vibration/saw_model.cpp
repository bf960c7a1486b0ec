// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/saw_model.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/prediction/burg.hpp"
#include "dsp/signal/prediction/line_frequencies.hpp"
#include "dsp/vibration/refine_rate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace tactus::vibration {

namespace {

constexpr double model_rate = SawModelSize::residual_rate;
constexpr double highest_modelled = 0.375 * model_rate;  // Hz: below the resampling's roll-off
constexpr std::size_t strokes_per_segment = 32, fewest_strokes = 16;
// The resampling removes what lies above the band. A noise floor under it spares the filter that steep edge.
constexpr double noise_floor = 3e-3;  // of the residual's rms

using Phasors = std::array<std::complex<double>, SawModelSize::max_orders>;

/// The orders of one recording: their mean phasors, and their powers without the noise.
struct Orders {
    Phasors mean{};  // peak amplitudes
    std::array<double, SawModelSize::max_orders> rms{};
    std::vector<double> residual;  // from sample `begin` on: where two segments overlap
    std::size_t begin = 0;
};

/// Fourier sum at `frequency` (cycles per sample) under a Hann window that starts at sample `begin`, as a peak phasor at
/// sample 0.
std::complex<double> phasor(std::span<const double> samples, std::size_t begin, std::size_t length, double frequency) {
    const std::complex<double> turn = std::polar(1.0, -2.0 * pi * frequency);
    std::complex<double> sum = 0.0, at = std::polar(1.0, -2.0 * pi * frequency * static_cast<double>(begin));
    for (std::size_t i = 0; i < length; ++i, at *= turn) {
        const double hann = 1.0 - std::cos(2.0 * pi * static_cast<double>(i) / static_cast<double>(length));
        sum += samples[begin + i] * hann * at;
    }
    return 2.0 / static_cast<double>(length) * sum;
}

Orders split(std::span<const double> samples, double rate) {
    const double strokes = static_cast<double>(samples.size()) * rate / model_rate;
    const double per_segment = std::min<double>(strokes_per_segment, std::floor(strokes / 2.0));
    const auto length = static_cast<std::size_t>(2.0 * std::round(0.5 * per_segment * model_rate / rate));
    const std::size_t step = length / 2, segments = (samples.size() - length) / step + 1;
    const auto count = std::min(SawModelSize::max_orders, static_cast<std::size_t>(highest_modelled / rate));
    Orders out;
    // The windows of the segments add up to 1 where two of them overlap.
    std::vector<double> periodic(samples.size(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
        const double order = static_cast<double>(k + 1) * rate / model_rate, aside = 0.5 * rate / model_rate;
        double power = 0.0, noise = 0.0;
        for (std::size_t s = 0; s < segments; ++s) {
            const std::size_t begin = s * step;
            const std::complex<double> here = phasor(samples, begin, length, order);
            out.mean[k] += here / static_cast<double>(segments);
            power += std::norm(here);
            noise += 0.5 * (std::norm(phasor(samples, begin, length, order - aside)) +
                            std::norm(phasor(samples, begin, length, order + aside)));
            const std::complex<double> turn = std::polar(1.0, 2.0 * pi * order);
            std::complex<double> at = here * std::polar(1.0, 2.0 * pi * order * static_cast<double>(begin));
            for (std::size_t i = 0; i < length; ++i, at *= turn)
                periodic[begin + i] +=
                    (0.5 - 0.5 * std::cos(2.0 * pi * static_cast<double>(i) / static_cast<double>(length))) * at.real();
        }
        out.rms[k] = std::sqrt(0.5 * std::max(0.0, power - noise) / static_cast<double>(segments));
    }
    out.begin = step;
    for (std::size_t i = step; i < segments * step; ++i) out.residual.push_back(samples[i] - periodic[i]);
    return out;
}

/// Shift in cycles that brings `orders` closest to `reference`.
double shift_to(const Phasors& orders, const Phasors& reference) {
    const auto agreement = [&](double shift) {
        double sum = 0.0;
        for (std::size_t k = 0; k < orders.size(); ++k)
            sum += std::real(orders[k] * std::polar(1.0, 2.0 * pi * static_cast<double>(k + 1) * shift) *
                             std::conj(reference[k]));
        return sum;
    };
    constexpr int places = 2048;
    int best = 0;
    for (int i = 1; i < places; ++i)
        if (agreement(i / double{places}) > agreement(best / double{places})) best = i;
    return best / double{places};
}

/// Filter, level and swell of a residual whose first sample is `begin` samples after the recording's. `shift` in cycles.
void fit_residual(std::vector<double> residual, std::size_t begin, double rate, double shift, SawSound& sound) {
    double power = 0.0;
    for (const double x : residual) power += x * x / static_cast<double>(residual.size());
    sound.residual = std::sqrt(power);
    const Random random{0x5a3d};
    for (std::size_t i = 0; i < residual.size(); ++i)
        residual[i] += (noise_floor * sound.residual + 1e-12) * random.normal(i);
    const std::vector<double> reflection = signal::burg(residual, SawModelSize::lines);
    std::array<double, SawModelSize::lines> predictor{};
    signal::predictor_of(reflection, predictor);
    const std::vector<double> lines = signal::line_frequencies(predictor);
    std::ranges::copy(lines, sound.lines.begin());

    double all = 0.0;
    for (std::size_t i = SawModelSize::lines; i < residual.size(); ++i) {
        double excitation = residual[i];
        for (std::size_t k = 0; k < predictor.size(); ++k) excitation += predictor[k] * residual[i - 1 - k];
        const double at = excitation * excitation;
        const double angle = 2.0 * pi * (static_cast<double>(begin + i) * rate / model_rate - shift);
        all += at;
        for (std::size_t m = 0; m < SawModelSize::swells; ++m) {
            sound.swell_cos[m] += 2.0 * at * std::cos(static_cast<double>(m + 1) * angle);
            sound.swell_sin[m] += 2.0 * at * std::sin(static_cast<double>(m + 1) * angle);
        }
    }
    for (std::size_t m = 0; m < SawModelSize::swells && all > 0.0; ++m) {
        sound.swell_cos[m] /= all;
        sound.swell_sin[m] /= all;
    }
}

}  // namespace

SawModel fit_saw_model(std::span<const SawRecording> recordings) {
    if (recordings.empty()) throw Error("the model of a saw needs at least one recording");
    if (recordings.size() > SawModel::max_conditions)
        throw Error(fmt::format("the model of a saw takes at most {} recordings, not {}", SawModel::max_conditions,
                                recordings.size()));
    const auto cuts = [](const SawRecording& recording) { return recording.cutting; };
    const auto known = [](const SawRecording& recording) { return recording.cutting && recording.density > 0.0; };
    if (const auto count = std::ranges::count_if(recordings, known);
        count != 0 && count != std::ranges::count_if(recordings, cuts))
        throw Error("some cutting recordings state the bone's density and some do not; state it for all or for none");
    SawModel model;
    std::vector<Orders> orders;
    std::size_t strongest = 0;
    double most = -1.0;
    for (const SawRecording& recording : recordings) {
        const std::span<const float> part = recording.part();
        const double rate = refine_rate(part, recording.sample_rate, recording.reciprocation_rate, 0.02);
        std::vector<double> samples = signal::resample(part, recording.sample_rate, model_rate);
        for (double& x : samples) x *= recording.gain;
        if (const double strokes = static_cast<double>(samples.size()) * rate / model_rate; strokes < fewest_strokes)
            throw Error(fmt::format("a recording of {:.1f} strokes is too short for a model; {} are needed", strokes,
                                    fewest_strokes));
        orders.push_back(split(samples, rate));
        model.conditions.push_back({rate,
                                    recording.cutting,
                                    recording.cutting ? recording.load : 0.0,
                                    recording.cutting ? recording.density : 0.0,
                                    {}});
        double power = 0.0;
        for (const double rms : orders.back().rms) power += rms * rms;
        if (power > most) {
            most = power;
            strongest = orders.size() - 1;
        }
    }
    const Phasors reference = orders[strongest].mean;
    for (std::size_t k = 0; k < reference.size(); ++k) model.phases[k] = std::arg(reference[k]);
    for (std::size_t i = 0; i < orders.size(); ++i) {
        SawCondition& condition = model.conditions[i];
        condition.sound.orders = orders[i].rms;
        fit_residual(std::move(orders[i].residual), orders[i].begin, condition.rate,
                     shift_to(orders[i].mean, reference), condition.sound);
    }
    return model;
}

}  // namespace tactus::vibration

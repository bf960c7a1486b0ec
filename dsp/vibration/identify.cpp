// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/identify.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/transform.hpp"
#include "dsp/vibration/local_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace tactus::vibration {

namespace {

using Complex = std::complex<double>;
using Spectrum = std::vector<Complex>;

struct Spectra {
    Spectrum drive;
    std::vector<Spectrum> answers;  ///< one per repeat
    double step = 0.0;              ///< Hz from bin to bin
    std::size_t size = 0;           ///< of the transform, samples
    double oversampling = 1.0;      ///< bins per independent one
};

Spectra transform(const SweepRun& run, std::span<const float> captured, double rate) {
    const auto period = static_cast<std::size_t>(std::llround((run.sweep.duration + run.pause) * rate));
    const auto repeats = static_cast<std::size_t>(run.repeats);
    if (captured.size() + 1 < period * repeats)
        throw Error(fmt::format("the answer to the sweep is {:.3g} s long; {:.3g} s were played",
                                static_cast<double>(captured.size()) / rate,
                                static_cast<double>(period * repeats) / rate));
    Spectra spectra;
    spectra.size = std::bit_ceil(period);
    spectra.step = rate / static_cast<double>(spectra.size);
    spectra.oversampling = static_cast<double>(spectra.size) / static_cast<double>(period);
    std::vector<double> samples(period);
    for (std::size_t i = 0; i < period; ++i) samples[i] = run.amplitude * run.sweep(static_cast<double>(i) / rate);
    spectra.drive = signal::spectrum_of(samples, spectra.size);
    for (std::size_t r = 0; r < repeats; ++r) {
        for (std::size_t i = 0; i < period; ++i) {
            const std::size_t at = r * period + i;
            samples[i] = at < captured.size() ? static_cast<double>(captured[at]) : 0.0;
        }
        spectra.answers.push_back(signal::spectrum_of(samples, spectra.size));
    }
    return spectra;
}

/// Cross-spectrum and powers of the responses around `hz` with the delay removed, averaged with a Hann window.
struct Average {
    Complex cross = 0.0;
    double drive = 0.0, answer = 0.0;

    Complex gain() const { return drive > 0.0 ? cross / drive : 0.0; }
    double coherence() const {
        const double product = drive * answer;
        return product > 0.0 ? std::min(1.0, std::norm(cross) / product) : 0.0;
    }
};

Average average(const Spectra& spectra, double hz, double width, double delay) {
    const double first = std::max(1.0, std::ceil((hz - width) / spectra.step));
    const double last =
        std::min(static_cast<double>(spectra.drive.size() - 1), std::floor((hz + width) / spectra.step));
    Average sum;
    for (double bin = first; bin <= last; ++bin) {
        const auto k = static_cast<std::size_t>(bin);
        const double f = bin * spectra.step;
        const double weight = 0.5 + 0.5 * std::cos(pi * (f - hz) / width);
        const Complex turn = std::polar(weight, 2.0 * pi * (f - hz) * delay);
        for (const Spectrum& answer : spectra.answers) {
            sum.cross += turn * std::conj(spectra.drive[k]) * answer[k];
            sum.drive += weight * std::norm(spectra.drive[k]);
            sum.answer += weight * std::norm(answer[k]);
        }
    }
    return sum;
}

/// The model of the bins around `hz`, without the delay.
LocalModel local_model(const Spectra& spectra, double hz, double width, double delay, std::vector<ResponseBin>& bins) {
    bins.clear();
    const double first = std::max(1.0, std::ceil((hz - width) / spectra.step));
    const double last =
        std::min(static_cast<double>(spectra.drive.size() - 1), std::floor((hz + width) / spectra.step));
    for (double bin = first; bin <= last; ++bin) {
        const auto k = static_cast<std::size_t>(bin);
        const double f = bin * spectra.step, drive = std::norm(spectra.drive[k]);
        if (!(drive > 0.0)) continue;
        Complex sum = 0.0;
        for (const Spectrum& answer : spectra.answers) sum += answer[k];
        const auto repeats = static_cast<double>(spectra.answers.size());
        bins.push_back({f, sum / (repeats * spectra.drive[k]) * std::polar(1.0, 2.0 * pi * f * delay),
                        (0.5 + 0.5 * std::cos(pi * (f - hz) / width)) * drive * repeats});
    }
    return fit_local_model(bins, hz, width, spectra.oversampling);
}

/// How much of its amplitude a resonance still has at the end of the period, which begins to ring when the sweep passes.
double left_at_the_end(const SweepRun& run, double hz, double damping) {
    const double passes = run.sweep.growth() * std::log(hz / run.sweep.first);
    return std::exp(-damping * 2.0 * pi * hz * (run.sweep.duration + run.pause - passes));
}

/// Time of the impulse response's peak within the swept band, s.
double coarse_delay(const SweepRun& run, const Spectra& spectra, double rate) {
    Spectrum cross(spectra.drive.size());
    double greatest = 0.0;
    for (const Complex& x : spectra.drive) greatest = std::max(greatest, std::norm(x));
    for (std::size_t k = 1; k < cross.size(); ++k) {
        const double f = static_cast<double>(k) * spectra.step;
        if (f < run.sweep.first || f > run.sweep.last) continue;
        // A window over the octaves reduces the ringing of the band's edges beside the peak.
        const double place = std::log(f / run.sweep.first) / std::log(run.sweep.last / run.sweep.first);
        const double window = std::sin(pi * place);
        for (const Spectrum& answer : spectra.answers)
            cross[k] += window * window * std::conj(spectra.drive[k]) * answer[k] /
                        (std::norm(spectra.drive[k]) + 1e-6 * greatest);
    }
    const std::vector<double> impulse = signal::samples_of(cross);
    const auto end = static_cast<std::size_t>(run.pause * rate);
    std::size_t peak = 0;
    for (std::size_t i = 0; i < std::min(end, impulse.size()); ++i)
        if (std::abs(impulse[i]) > std::abs(impulse[peak])) peak = i;
    if (!(std::abs(impulse[peak]) > 0.0)) throw Error("the sweep does not come back: the answer is silent");
    return static_cast<double>(peak) / rate;
}

/// Delay beyond minimum phase: slope of the excess phase over frequency, s.
double excess_delay(const FrequencyResponse& response) {
    std::vector<double> magnitude;
    for (const Complex& gain : response.gain)
        magnitude.push_back(std::max(std::abs(gain), std::numeric_limits<double>::min()));
    const std::vector<double> least = minimum_phase(response.hz, magnitude);
    const std::vector<double> phase = unwrapped_phase(response.gain);
    // Linear regression; the intercept at 0 Hz is a polarity and stays in the response.
    double w = 0.0, wf = 0.0, wff = 0.0, wp = 0.0, wfp = 0.0;
    const double low = 2.0 * response.hz.front(), high = 0.5 * response.hz.back();
    for (std::size_t i = 0; i < phase.size(); ++i) {
        const double f = response.hz[i], rest = phase[i] - least[i];
        if (f < low || f > high) continue;
        const double weight = std::pow(response.coherence[i], 4);
        w += weight, wf += weight * f, wff += weight * f * f, wp += weight * rest, wfp += weight * f * rest;
    }
    const double spread = w * wff - wf * wf;
    return spread > 0.0 ? -(w * wfp - wf * wp) / spread / (2.0 * pi) : 0.0;
}

/// s: of a sweep that halves 5 % of the deviation and of the truncation of a mode.
double needed_duration(const SweepRun& run, const Mode& mode) {
    const double noise = std::pow(2.0 * mode.deviation / 0.05, 2.0);
    const double ringing = std::log(1.0 / 0.05) / (mode.damping * 2.0 * pi * mode.hz);
    const double passes = std::log(mode.hz / run.sweep.first) / std::log(run.sweep.last / run.sweep.first);
    return std::max(run.sweep.duration * std::max(1.0, noise), (ringing - run.pause) / std::max(0.05, 1.0 - passes));
}

/// The mode of a model around its own pole; none unless the pole is within the window, significant and stands out.
std::optional<Mode> mode_near(const SweepRun& run, const Spectra& spectra, const LocalModel& coarse, double delay,
                              std::vector<ResponseBin>& bins) {
    const double width = coarse.half_width;
    if (!coarse.is_significant() || std::abs(coarse.frequency() - coarse.centre) > 0.5 * width) return std::nullopt;
    const LocalModel model = local_model(spectra, coarse.frequency(), width, delay, bins);
    if (!model.is_significant()) return std::nullopt;
    const double f0 = model.frequency(), half = model.pole().imag();
    if (std::abs(f0 - model.centre) > 0.25 * width || 2.5 * half > width || model.pole_deviation > 0.5 * half)
        return std::nullopt;
    Mode mode{f0, model.damping(), model.pole_deviation / half, left_at_the_end(run, f0, model.damping()), 0.0, 0.0};
    for (int i = -20; i <= 20; ++i) mode.peak = std::max(mode.peak, std::abs(model(f0 + 0.1 * i * half)));
    for (const double side : {-1.0, 1.0})
        if (mode.peak < 1.1 * std::abs(model(f0 + 2.0 * side * half))) return std::nullopt;
    return mode;
}

/// The deviation of a mode, and what a window half or twice as wide finds otherwise: of many windows the one with the least
/// deviation was taken, which may be so by chance. The narrow window counts where it is not too noisy: the wide one is biased by
/// what its parabola does not hold.
double deviation_among_windows(const Spectra& spectra, const Mode& mode, double window, double delay,
                               std::vector<ResponseBin>& bins) {
    for (const double other : {0.5 * window, 2.0 * window}) {
        if (other > 0.5 * mode.hz) continue;
        const LocalModel model = local_model(spectra, mode.hz, other, delay, bins);
        const bool is_quiet = model.pole_deviation < 0.025 * model.pole().imag();
        if (!model.is_significant() || (other < window && !is_quiet)) continue;
        return std::max(mode.deviation, 0.5 * std::abs(model.damping() / mode.damping - 1.0));
    }
    return std::max(mode.deviation, 0.05);
}

/// Resonances by models of windows from `width` on, up to 64 times as wide: the narrowest window that resolves one leaves
/// the least to the parabola, and so the least bias; a wider one counts where that is too noisy.
std::vector<Mode> modes_of(const SweepRun& run, const Spectra& spectra, std::span<const double> hz, double width,
                           double delay) {
    std::vector<Mode> modes;
    std::vector<double> windows;  // of each mode
    std::vector<ResponseBin> bins;
    std::size_t stride = 1;  // of the centres: windows overlap by more than half
    for (double window = width; window <= 64.0 * width; window *= 2.0, stride = std::min<std::size_t>(2 * stride, 8))
        for (std::size_t i = 0; i < hz.size(); i += stride) {
            const double f = hz[i];
            if (window > 0.5 * f) continue;
            const auto mode = mode_near(run, spectra, local_model(spectra, f, window, delay, bins), delay, bins);
            if (!mode || mode->hz < hz.front() || mode->hz > hz.back()) continue;
            const auto known = std::ranges::find_if(modes, [&](const Mode& one) {
                return std::abs(one.hz - mode->hz) < std::max(one.hz * one.damping, mode->hz * mode->damping);
            });
            if (known == modes.end()) modes.push_back(*mode), windows.push_back(window);
            else if (known->deviation > 0.025 && mode->deviation < known->deviation)
                *known = *mode, windows[static_cast<std::size_t>(known - modes.begin())] = window;
        }
    for (std::size_t n = 0; n < modes.size(); ++n) {
        Mode& mode = modes[n];
        mode.deviation = deviation_among_windows(spectra, mode, windows[n], delay, bins);
        mode.needed_duration = needed_duration(run, mode);
    }
    std::ranges::sort(modes, {}, &Mode::hz);
    return modes;
}

/// Adds frequencies around each mode, a quarter of its half width apart. `add` appends the response at a frequency.
template <class Add>
void refine(FrequencyResponse& response, const std::vector<Mode>& modes, const Add& add) {
    if (modes.empty()) return;
    const double low = response.hz.front(), high = response.hz.back();
    for (const Mode& mode : modes)
        for (int i = -32; i <= 32; ++i) {
            const double f = mode.hz * (1.0 + 0.25 * mode.damping * i);
            if (f > low && f < high) add(f);
        }
    std::vector<std::size_t> order(response.hz.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order, {}, [&](std::size_t i) { return response.hz[i]; });
    FrequencyResponse sorted;
    sorted.latency = response.latency;
    for (const std::size_t i : order) {
        if (!sorted.hz.empty() && response.hz[i] <= sorted.hz.back() * (1.0 + 1e-9)) continue;
        sorted.hz.push_back(response.hz[i]);
        sorted.gain.push_back(response.gain[i]);
        sorted.coherence.push_back(response.coherence[i]);
    }
    response = std::move(sorted);
}

}  // namespace

Identified identify(const SweepRun& run, std::span<const float> captured, double rate, int highest_order,
                    int per_octave) {
    const ExponentialSweep& sweep = run.sweep;
    if (!(sweep.first > 0.0 && sweep.last > 2.0 * sweep.first && sweep.last < 0.5 * rate && sweep.duration > 0.0 &&
          run.repeats >= 1 && run.amplitude != 0.0))
        throw Error("a sweep needs at least an octave, below half the sample rate, and an amplitude");
    const Spectra spectra = transform(run, captured, rate);
    // Wide enough to reject the second order, which lies lead(2) earlier, and to hold a few dozen bins; as a window
    // in time this keeps ±1/width around the linear response.
    const double width = std::max({2.5, 1.5 / sweep.lead(2), 12.0 * spectra.step});
    Identified out;
    FrequencyResponse& response = out.response;
    // Fades and averaging distort the outermost frequencies.
    const double first = sweep.first + width, last = sweep.last - width;
    const int count = static_cast<int>(std::floor(std::log2(last / first) * per_octave)) + 1;
    for (int i = 0; i < count; ++i) response.hz.push_back(first * std::exp2(static_cast<double>(i) / per_octave));

    std::vector<ResponseBin> bins;
    const auto add = [&](double f, double delay, const LocalModel& model) {
        const Average here = average(spectra, model.is_significant() ? model.centre : f, width, delay);
        Complex gain = here.gain() * std::polar(1.0, 2.0 * pi * f * delay);
        double coherence = here.coherence();
        if (model.is_significant()) {
            gain = model(f);
            // Of the power of the bins the part that the model explains.
            double explained = 0.0;
            for (const ResponseBin& bin : bins) explained += bin.weight * std::norm(model(bin.hz));
            coherence = std::min(1.0, explained / std::max(here.answer, 1e-300));
        }
        response.hz.push_back(f);
        response.gain.push_back(gain);
        response.coherence.push_back(coherence);
    };
    const auto measure = [&](double delay) {
        const std::vector<double> hz = std::move(response.hz);
        response = {};
        response.latency = delay;
        for (const double f : hz) add(f, delay, local_model(spectra, f, width, delay, bins));
    };
    measure(coarse_delay(run, spectra, rate));
    measure(response.latency + excess_delay(response));
    out.modes = modes_of(run, spectra, response.hz, width, response.latency);
    refine(response, out.modes,
           [&](double f) { add(f, response.latency, local_model(spectra, f, width, response.latency, bins)); });

    // The linear response is far stronger and must not leak in: a wider average rejects it better.
    const double wide = 3.0 * width;
    for (int order = 2; order <= highest_order; ++order) {
        Distortion& distortion = out.distortions.emplace_back();
        distortion.order = order;
        for (std::size_t i = 0; i < response.hz.size(); ++i) {
            const double f = order * response.hz[i];
            const double fundamental = std::abs(response.gain[i]);
            distortion.ratio.push_back(
                f <= last && fundamental > 0.0
                    ? std::abs(average(spectra, f, wide, response.latency - sweep.lead(order)).gain()) / fundamental
                    : std::numeric_limits<double>::quiet_NaN());
        }
    }
    return out;
}

}  // namespace tactus::vibration

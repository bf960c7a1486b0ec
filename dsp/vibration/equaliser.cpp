// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/equaliser.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace tactus::vibration {

namespace {

using Complex = std::complex<double>;

void check(const FrequencyResponse& response, const EqualiserDesign& design) {
    if (response.hz.size() < 3) throw Error("an equaliser needs the response at 3 frequencies or more");
    if (!(design.lowest > 0.0 && design.highest > 2.0 * design.lowest))
        throw Error("the equaliser's band must be at least an octave, above 0 Hz");
    if (!(2.2 * design.highest <= design.rate))
        throw Error(fmt::format("a rate of {:g} Hz is too low for a band up to {:g} Hz", design.rate, design.highest));
    // Up to a third of an octave beyond the measurement, the last value is held.
    if (response.hz.front() > 1.26 * design.lowest || response.hz.back() < design.highest / 1.26)
        throw Error(fmt::format("the response covers {:.4g} to {:.4g} Hz, the equaliser's band is {:g} to {:g} Hz",
                                response.hz.front(), response.hz.back(), design.lowest, design.highest));
    if (!(design.length * design.lowest >= 2.0 && design.length <= 2.0))
        throw Error(fmt::format("the equaliser's length must lie between {:.3g} s (two periods of {:g} Hz) and 2 s",
                                2.0 / design.lowest, design.lowest));
    if (!(design.greatest_gain > 0.0 && design.regularisation >= 0.0))
        throw Error("the equaliser's greatest gain must be above 0 and its regularisation not below");
}

/// Geometric mean of the magnitude over the octaves of the band.
double mean_gain(const FrequencyResponse& response, double lowest, double highest) {
    constexpr int count = 200;
    std::vector<double> hz(count);
    for (int i = 0; i < count; ++i)
        hz[static_cast<std::size_t>(i)] = lowest * std::pow(highest / lowest, (i + 0.5) / count);
    double sum = 0.0;
    for (const Complex& gain : interpolate(response, hz)) sum += std::log(std::max(std::abs(gain), 1e-300));
    return std::exp(sum / count);
}

/// β(f) relative to g²: small in the band, 1 an octave below and half an octave above, linear in log β in between.
double regularisation(double f, const EqualiserDesign& design) {
    const double below = std::log2(design.lowest / f), above = std::log2(f / design.highest) / std::log2(1.5);
    const double outside = std::clamp(std::max(below, above), 0.0, 1.0);
    return std::pow(std::max(design.regularisation, 1e-12), 1.0 - outside);
}

/// Spectrum of the minimum-phase sequence with those magnitudes (folding of the real cepstrum).
std::vector<Complex> to_minimum_phase(const std::vector<Complex>& spectrum) {
    std::vector<Complex> half(spectrum.size());
    double greatest = 0.0;
    for (const Complex& value : spectrum) greatest = std::max(greatest, std::abs(value));
    for (std::size_t k = 0; k < half.size(); ++k) half[k] = std::log(std::max(std::abs(spectrum[k]), 1e-6 * greatest));
    std::vector<double> cepstrum = signal::samples_of(half);
    const std::size_t size = cepstrum.size();
    for (std::size_t i = 1; i < size / 2; ++i) {
        cepstrum[i] *= 2.0;
        cepstrum[size - i] = 0.0;
    }
    half = signal::spectrum_of(cepstrum, size);
    for (Complex& value : half) value = std::exp(value);
    return half;
}

}  // namespace

std::complex<double> Equaliser::gain(double frequency) const {
    const Complex step = std::polar(1.0, -2.0 * pi * frequency / rate);
    Complex turn = 1.0, sum = 0.0;
    for (const float tap : taps) {
        sum += static_cast<double>(tap) * turn;
        turn *= step;
    }
    return sum;
}

Equaliser design_equaliser(const FrequencyResponse& response, const EqualiserDesign& design) {
    check(response, design);
    const auto count = static_cast<std::size_t>(std::llround(design.length * design.rate));
    // The inverse of a sharp resonance is longer than the filter: compute it with a longer transform against time
    // aliasing.
    const std::size_t size = std::bit_ceil(8 * count);
    const bool linear = design.kind == EqualiserKind::linear_phase;

    Equaliser out;
    out.kind = design.kind;
    out.rate = design.rate;
    out.lowest = design.lowest;
    out.highest = design.highest;
    const double g = out.mean_gain = mean_gain(response, design.lowest, design.highest);
    if (!(g > 1e-30 && g < 1e30)) throw Error("the response is silent in the equaliser's band");

    std::vector<double> hz(size / 2);
    for (std::size_t k = 0; k < hz.size(); ++k)
        hz[k] = static_cast<double>(k + 1) * design.rate / static_cast<double>(size);
    const std::vector<Complex> h = interpolate(response, hz);
    const std::size_t centre = linear ? count / 2 : 0;
    const double fade = linear ? 0.5 * static_cast<double>(count) : 0.25 * static_cast<double>(count);
    const auto taps_with = [&](double greatest_gain) {
        std::vector<Complex> spectrum(size / 2 + 1);
        for (std::size_t k = 0; k < hz.size(); ++k) {
            const Complex inverse = g * std::conj(h[k]) / (std::norm(h[k]) + regularisation(hz[k], design) * g * g);
            const double gain = std::abs(inverse);
            spectrum[k + 1] = gain > greatest_gain ? inverse * (greatest_gain / gain) : inverse;
        }
        if (!linear) spectrum = to_minimum_phase(spectrum);
        spectrum.back() = spectrum.back().real();
        const std::vector<double> impulse = signal::samples_of(spectrum);
        std::vector<double> taps;
        for (std::size_t i = 0; i < count; ++i) {
            const double left = linear ? static_cast<double>(i) + 0.5 : fade;
            const double right = static_cast<double>(count - i) - 0.5, edge = std::min({left, right, fade}) / fade;
            taps.push_back((0.5 - 0.5 * std::cos(pi * edge)) * impulse[(size + i - centre) % size]);
        }
        return taps;
    };
    // Cutting the impulse response ripples its gain: the limit is that of the taps.
    double limit = design.greatest_gain;
    std::vector<double> taps = taps_with(limit);
    for (int round = 0; round < 4; ++round) {
        double greatest = 0.0;
        for (const Complex& gain : signal::spectrum_of(taps, size)) greatest = std::max(greatest, std::abs(gain));
        if (greatest <= 1.005 * design.greatest_gain) break;
        limit *= design.greatest_gain / greatest;
        taps = taps_with(limit);
    }
    for (const double tap : taps) out.taps.push_back(static_cast<float>(tap));
    const auto peak = std::ranges::max_element(out.taps, {}, [](float tap) { return std::abs(tap); });
    out.delay = static_cast<double>(linear ? static_cast<std::ptrdiff_t>(centre) : peak - out.taps.begin()) / out.rate;
    return out;
}

}  // namespace tactus::vibration

// SPDX-License-Identifier: Apache-2.0
#include "dsp/spectrum/comparison.hpp"

#include "dsp/core/error.hpp"
#include "dsp/filter/resample.hpp"
#include "dsp/spectrum/bands.hpp"
#include "dsp/spectrum/comb.hpp"
#include "dsp/spectrum/cross.hpp"
#include "dsp/spectrum/welch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus {

namespace {

constexpr double rate = 8000.0;  // Hz: everything here lies below 1 kHz
constexpr double touch_end = 500.0;
constexpr double shortest = 0.5;  // s
constexpr double silence = 1e-5;  // of the peak
// Segments for distance and cosine, coherence, bands, lines.
constexpr std::size_t coarse = 1024, middle = 2048, fine = 4096, sharp = 8192;
constexpr double speed_range = 0.03;
constexpr double lowest_rate = 60.0, highest_rate = 400.0;  // of a saw, Hz

double decibel(double power_ratio) { return 10.0 * std::log10(power_ratio); }

std::vector<double> at_common_rate(const Take& take, const char* name) {
    if (!(take.rate > 0.0) || static_cast<double>(take.samples.size()) < shortest * take.rate)
        throw Error(fmt::format("the {} is shorter than {} s", name, shortest));
    return resample(take.samples, take.rate, rate);
}

/// Power in the band. Throws Error when that is nothing beside the greatest value, as in a constant.
double power_in_band(std::span<const double> samples, const Spectrum& density, const Comparison& result,
                     const char* name) {
    double peak = 0.0;
    for (const double x : samples) peak = std::max(peak, std::abs(x));
    const double power = band_power(density, result.lowest, result.highest);
    if (!(std::sqrt(power) > silence * peak))
        throw Error(fmt::format("the {} is silent from {:g} to {:g} Hz", name, result.lowest, result.highest));
    return power;
}

/// Both takes at `rate`, and the longest segment of which either holds four.
struct Takes {
    std::span<const double> reference, output;
    std::size_t longest = std::bit_floor(std::min(reference.size(), output.size()) / 4);

    WelchSettings settings(std::size_t segment) const {
        WelchSettings settings;
        settings.rate = rate;
        settings.segment = std::min(segment, longest);
        settings.overlap = settings.segment / 2;
        return settings;
    }
    Spectrum of_reference(std::size_t segment) const { return welch<double>(reference, settings(segment)); }
    Spectrum of_output(std::size_t segment) const { return welch<double>(output, settings(segment)); }
};

/// Hz; 0 when the lines are of no one rate.
double rate_of_strokes(const Spectrum& density) {
    const Comb comb = fit_comb(density, lowest_rate, highest_rate);
    return comb.confidence >= sure_of_comb ? comb.best.frequency : 0.0;
}

/// The output at the reference's rate of strokes, when both are known and near each other.
std::vector<double> at_equal_speed(std::span<const double> samples, Comparison& result) {
    const double ratio = result.output_hz / result.reference_hz;
    if (result.alignment.significant || !(std::abs(ratio - 1.0) < speed_range) || std::abs(ratio - 1.0) < 1e-5)
        return {samples.begin(), samples.end()};
    result.speed_ratio = ratio;
    return resample(samples, rate / ratio, rate);
}

void score_spectra(const Takes& takes, const ComparisonOptions& options, Comparison& result) {
    const Spectrum fine_reference = takes.of_reference(fine), fine_output = takes.of_output(fine);
    const double low = result.lowest, high = result.highest;
    const double reference_power = power_in_band(takes.reference, fine_reference, result, "reference");
    const double output_power = power_in_band(takes.output, fine_output, result, "output");
    result.reference_rms = std::sqrt(reference_power);
    result.output_rms = std::sqrt(output_power);
    result.gain_db = decibel(reference_power / output_power);
    const double gain = std::sqrt(reference_power / output_power);

    const Spectrum a = takes.of_reference(coarse), b = takes.of_output(coarse);
    const SpectrumPair pair{a.power, b.power, a.df};
    result.lsd_db = log_spectral_distance(pair, low, std::min(touch_end, high), gain);
    result.cosine_500 = spectral_cosine(pair, low, std::min(touch_end, high));
    result.cosine_1000 = spectral_cosine(pair, low, high);
    result.touch_cosine = spectral_cosine(pair, low, high, options.touch);
    double felt_reference = 0.0, felt_output = 0.0;
    for (std::size_t k = 0; k < a.power.size(); ++k) {
        const double f = a.frequency(k);
        if (f < low || f > high) continue;
        const double weight = std::pow(10.0, 0.1 * touch_weight_db(f, options.touch));
        felt_reference += weight * a.power[k];
        felt_output += weight * gain * gain * b.power[k];
    }
    result.touch_gap_db = decibel(felt_output / felt_reference);

    result.third_octaves =
        third_octave_errors({fine_reference.power, fine_output.power, fine_reference.df}, low, high, gain);
    double square = 0.0;
    for (const BandError& band : result.third_octaves) {
        result.third_octave_max_db = std::max(result.third_octave_max_db, std::abs(band.error_db));
        square += band.error_db * band.error_db / static_cast<double>(result.third_octaves.size());
    }
    result.third_octave_rms_db = std::sqrt(square);
    result.step = fine_reference.df;
    result.reference_density = fine_reference.power;
    for (const double power : fine_output.power) result.output_density.push_back(gain * gain * power);
}

/// The parts of both takes that were made at the same time, the output in the reference's polarity.
void cut_to_common(std::vector<double>& reference, std::vector<double>& output, const Alignment& alignment) {
    const double sign = alignment.correlation < 0.0 ? -1.0 : 1.0;
    reference = resample(reference, rate, rate, std::max(0.0, -alignment.delay));
    output = resample(output, rate, rate, std::max(0.0, alignment.delay));
    for (double& x : output) x *= sign;
    const std::size_t common = std::min(reference.size(), output.size());
    reference.resize(common);
    output.resize(common);
}

void score_waveforms(std::span<const double> x, std::span<const double> output, Comparison& result) {
    std::vector<double> y(output.begin(), output.end());
    for (double& sample : y) sample *= result.reference_rms / result.output_rms;
    result.st_sim = st_sim(x, y);
    result.spqi = spqi(x, y);
    result.signal_to_noise_db = signal_to_noise_db(x, y);
    const CrossSpectra cross = cross_spectra<double>(x, y, Takes{x, y}.settings(middle));
    result.coherence = cross.coherence();
    result.coherence_step = cross.df;
    // Only where the reference has something to say; between its lines there is noise of other origin.
    double greatest = 0.0, sum = 0.0, count = 0.0;
    const auto in_band = [&](std::size_t k) {
        return cross.frequency(k) >= result.lowest && cross.frequency(k) <= result.highest;
    };
    for (std::size_t k = 0; k < cross.xx.size(); ++k)
        if (in_band(k)) greatest = std::max(greatest, cross.xx[k]);
    for (std::size_t k = 0; k < cross.xx.size(); ++k)
        if (in_band(k) && cross.xx[k] > 1e-4 * greatest) sum += result.coherence[k], count += 1.0;
    result.coherence_mean = count > 0.0 ? sum / count : 0.0;
}

}  // namespace

Comparison compare(const Take& reference, const Take& output, const ComparisonOptions& options) {
    Comparison result;
    result.highest = std::min(1000.0, 0.45 * std::min(reference.rate, output.rate));
    if (!(result.highest >= 100.0))
        throw Error(fmt::format("a rate of {:g} Hz is too low to compare vibrations from 40 Hz on; 223 Hz is the least",
                                std::min(reference.rate, output.rate)));
    std::vector<double> r = at_common_rate(reference, "reference"), raw = at_common_rate(output, "output");
    result.alignment = align_takes(r, raw, rate, result.lowest, result.highest, options.longest_delay);

    if (result.alignment.significant) cut_to_common(r, raw, result.alignment);
    const Takes takes{r, raw};
    const Spectrum sharp_reference = takes.of_reference(sharp), sharp_output = takes.of_output(sharp);
    result.reference_hz = rate_of_strokes(sharp_reference);
    result.output_hz = rate_of_strokes(sharp_output);
    const std::vector<double> d = at_equal_speed(raw, result);
    score_spectra({r, d}, options, result);
    result.spectrogram_similarity = spectrogram_similarity(r, d, rate, result.lowest, result.highest);
    if (result.alignment.significant) score_waveforms(r, raw, result);
    // Of a saw at another speed, the orders are compared, each take at its own.
    const bool one_saw = std::abs(result.output_hz / result.reference_hz - 1.0) < speed_range;
    result.harmonic_error_db = harmonic_error(sharp_reference, result.reference_hz, sharp_output,
                                              one_saw ? result.output_hz : result.reference_hz, result.highest);
    result.lines = match_lines(sharp_reference, sharp_output, std::pow(10.0, result.gain_db / 20.0), result.speed_ratio,
                               result.lowest, result.highest);
    return result;
}

}  // namespace tactus

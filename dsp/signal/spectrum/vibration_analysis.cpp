// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/vibration_analysis.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr std::size_t max_peaks = 20;

/// Windows three quarters over each other, from three quarters before the record to three quarters after it: the sum of
/// their squares is the same at each sample.
WelchSettings band_settings(double rate, std::size_t frames) {
    const std::size_t segment = std::max<std::size_t>(4, suggested_segment(rate, frames) / 4 * 4);
    WelchSettings settings = WelchSettings::hann(rate, segment, segment / 4 * 3);
    settings.detrend = Detrend::none;
    return settings;
}

std::vector<SpectralLine> strongest(std::vector<SpectralLine> lines) {
    std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.power > b.power; });
    if (lines.size() > max_peaks) lines.resize(max_peaks);
    std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.frequency < b.frequency; });
    return lines;
}

bool same(const WelchSettings& a, const WelchSettings& b) {
    return a.segment == b.segment && a.overlap == b.overlap && a.window == b.window && a.detrend == b.detrend &&
           a.averaging == b.averaging;
}

}  // namespace

VibrationAnalysis::VibrationAnalysis(const AnalysisSettings& settings, std::size_t frames)
    : settings_(settings), frames_(frames) {
    if (settings.only_psd) {
        psd_.emplace(settings.psd);
        return;
    }
    const std::size_t segment = suggested_segment(settings.psd.rate, frames);
    if (!same(settings.psd, WelchSettings::hann(settings.psd.rate, segment, segment / 2))) psd_.emplace(settings.psd);
    bands_.emplace(band_settings(settings.psd.rate, frames));
    fundamental_.emplace(settings.psd.rate, frames, settings.lowest, settings.highest);
    if (settings.envelope) {
        const auto [low, high] = *settings.envelope;
        if (!(low > 0.0) || !(high > low) || !(high < 0.5 * settings.psd.rate))
            throw Error(fmt::format("the band {:g}:{:g} Hz of the envelope must lie between 0 Hz and {:g} Hz", low,
                                    high, 0.5 * settings.psd.rate));
        envelope_.emplace(low, high, settings.psd.rate);
        const std::size_t length = suggested_segment(envelope_->rate(), frames / envelope_->step());
        envelope_spectrum_.emplace(WelchSettings::hann(envelope_->rate(), length, length / 2));
    }
    if (settings.octave_filters > 0) octaves_.emplace(settings.octave_filters, settings.psd.rate, frames);
    if (settings.spectrogram) {
        const double longest = std::min(0.1 * settings.psd.rate, static_cast<double>(frames) / 8.0);
        spectrogram_.emplace(std::bit_floor(static_cast<std::size_t>(std::max(16.0, longest))), settings.psd.rate);
    }
}

void VibrationAnalysis::push(std::span<const double> samples) {
    if (settings_.only_psd) return psd_->push(samples);
    if (!known_level_) level_.push(samples);
    const double mean = known_level_ ? known_level_->mean() : 0.0;
    moments_.push(samples, mean);
    if (in_piece_ == 0) surround();
    shifted_.assign(samples.begin(), samples.end());
    for (double& x : shifted_) x -= mean;
    bands_->push(shifted_);
    if (octaves_) octaves_->push(shifted_);
    in_piece_ += samples.size();
    pushed_ += samples.size();
    if (psd_) psd_->push(samples);
    if (spectrogram_) spectrogram_->push(samples);
    if (envelope_) {
        envelope_values_.clear();
        double value = 0.0;
        for (const double x : samples)
            if ((*envelope_)(x, value)) envelope_values_.push_back(value);
        envelope_spectrum_->push(envelope_values_);
    }
    fundamental_->push(samples);
}

void VibrationAnalysis::surround() {
    const WelchSettings settings = band_settings(settings_.psd.rate, frames_);
    shifted_.assign(settings.overlap, 0.0);
    bands_->push(shifted_);
}

Spectrum VibrationAnalysis::band_spectrum() const {
    // A copy takes the end: more may be pushed after a report.
    WelchStream<double> ended = *bands_;
    const WelchSettings settings = band_settings(settings_.psd.rate, frames_);
    ended.push(std::vector<double>(settings.segment, 0.0));
    Spectrum spectrum = ended.spectrum();
    const double scale = static_cast<double>(spectrum.segments * settings.step()) /
                         static_cast<double>(std::max<std::size_t>(1, pushed_));
    for (double& power : spectrum.power) power *= scale;
    return spectrum;
}

void VibrationAnalysis::gap() {
    if (psd_) psd_->forget_waiting();
    if (settings_.only_psd) return;
    if (in_piece_ > 0) {
        const WelchSettings settings = band_settings(settings_.psd.rate, frames_);
        shifted_.assign(settings.segment, 0.0);
        bands_->push(shifted_);
        bands_->forget_waiting();
        in_piece_ = 0;
    }
    if (octaves_) octaves_->gap();
    fundamental_->gap();
}

VibrationReport VibrationAnalysis::report() const {
    VibrationReport out;
    if (settings_.only_psd) {
        out.psd = psd_->spectrum();
        return out;
    }
    out.level = known_level_.value_or(level_);
    out.lines = fundamental_->spectrum();
    out.psd = psd_ ? psd_->spectrum() : out.lines;
    out.moments = moments_;
    out.spectrogram = spectrogram_;
    if (octaves_) out.filtered = octaves_->bands();
    if (out.lines.power.size() < 8) return out;
    out.fundamental = fundamental_->estimate();
    out.harmonics = harmonic_table(out.lines, out.fundamental.frequency, settings_.orders);
    out.thd = total_harmonic_distortion(out.harmonics);
    out.cepstrum = real_cepstrum(out.lines);
    out.peaks = strongest(find_lines(out.lines, 2.0 * out.lines.df, settings_.psd.rate));
    out.hum = find_hum(out.lines, out.fundamental.frequency);
    const Spectrum of_bands = band_spectrum();
    out.bands = third_octaves(of_bands);
    estimate_leakage(out.bands, of_bands);
    if (envelope_spectrum_) {
        const Spectrum& envelope = out.envelope_spectrum.emplace(envelope_spectrum_->spectrum());
        const double highest = 0.5 * (settings_.envelope->second - settings_.envelope->first);
        out.envelope = strongest(find_lines(envelope, 2.0 * envelope.df, highest));
    }
    return out;
}

}  // namespace tactus::signal

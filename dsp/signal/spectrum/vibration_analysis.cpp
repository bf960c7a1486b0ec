// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/vibration_analysis.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr std::size_t most_peaks = 20;

WelchSettings hann(double rate, std::size_t segment, std::size_t overlap) {
    WelchSettings settings;
    settings.rate = rate;
    settings.segment = segment;
    settings.overlap = overlap;
    return settings;
}

/// Half a second, in segments short enough to keep a varying line together and long enough to resolve the lines of a
/// saw. A shorter record fills none and needs no memory for one.
WelchSettings block_settings(double rate, std::size_t frames) {
    const double longest = std::min(0.25 * rate, static_cast<double>(frames));
    const std::size_t segment = std::bit_floor(static_cast<std::size_t>(std::max(64.0, longest)));
    return hann(rate, segment, segment * 3 / 4);
}

std::vector<SpectralLine> strongest(std::vector<SpectralLine> lines) {
    std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.power > b.power; });
    if (lines.size() > most_peaks) lines.resize(most_peaks);
    std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.frequency < b.frequency; });
    return lines;
}

bool same(const WelchSettings& a, const WelchSettings& b) {
    return a.segment == b.segment && a.overlap == b.overlap && a.window == b.window && a.detrend == b.detrend &&
           a.averaging == b.averaging;
}

}  // namespace

VibrationAnalysis::VibrationAnalysis(const AnalysisSettings& settings, std::size_t frames)
    : settings_(settings),
      lines_(hann(settings.psd.rate, suggested_segment(settings.psd.rate, frames),
                  suggested_segment(settings.psd.rate, frames) / 2)),
      block_(block_settings(settings.psd.rate, frames)),
      fresh_block_(block_),
      block_length_(static_cast<std::size_t>(std::ceil(0.5 * settings.psd.rate))) {
    const std::size_t segment = suggested_segment(settings.psd.rate, frames);
    if (!same(settings.psd, hann(settings.psd.rate, segment, segment / 2))) psd_.emplace(settings.psd);
    if (settings.envelope) {
        const auto [low, high] = *settings.envelope;
        if (!(low > 0.0) || !(high > low) || !(high < 0.5 * settings.psd.rate))
            throw Error(fmt::format("the band {:g}:{:g} Hz of the envelope must lie between 0 Hz and {:g} Hz", low,
                                    high, 0.5 * settings.psd.rate));
        envelope_.emplace(low, high, settings.psd.rate);
        const std::size_t length = suggested_segment(envelope_->rate(), frames / envelope_->step());
        envelope_spectrum_.emplace(hann(envelope_->rate(), length, length / 2));
    }
    if (settings.spectrogram) {
        const double longest = std::min(0.1 * settings.psd.rate, static_cast<double>(frames) / 8.0);
        spectrogram_.emplace(std::bit_floor(static_cast<std::size_t>(std::max(16.0, longest))), settings.psd.rate);
    }
}

void VibrationAnalysis::push(std::span<const double> samples) {
    level_.push(samples);
    lines_.push(samples);
    if (psd_) psd_->push(samples);
    if (spectrogram_) spectrogram_->push(samples);
    if (envelope_) {
        envelope_values_.clear();
        double value = 0.0;
        for (const double x : samples)
            if ((*envelope_)(x, value)) envelope_values_.push_back(value);
        envelope_spectrum_->push(envelope_values_);
    }
    while (!samples.empty()) {
        const std::size_t part = std::min(samples.size(), block_length_ - in_block_);
        block_.push(samples.first(part));
        for (std::size_t i = 0; i < part; ++i) {
            const double step = samples[i] - last_;
            movement_[(in_block_ + i) * movement_.size() / block_length_] += step * step;
            last_ = samples[i];
        }
        samples = samples.subspan(part);
        in_block_ += part;
        if (in_block_ == block_length_) end_block();
    }
}

void VibrationAnalysis::end_block() {
    const Spectrum spectrum = block_.spectrum();
    if (!spectrum.power.empty()) {
        const Comb comb = fit_comb(spectrum, settings_.lowest, settings_.highest);
        // An impact excites many frequencies at once: the ripples of its spectrum are no lines.
        double all = 1e-300, most = 0.0;
        for (const double movement : movement_) all += movement, most = std::max(most, movement);
        if (comb.confidence > 0.1 && most < 0.4 * all) seconds_.push_back({comb.best.frequency, comb.confidence});
        else seconds_.push_back({0.0, 0.0});
    }
    block_ = fresh_block_;
    in_block_ = 0;
    movement_.fill(0.0);
}

void VibrationAnalysis::gap() {
    lines_.forget_waiting();
    if (psd_) psd_->forget_waiting();
    block_ = fresh_block_;
    in_block_ = 0;
    movement_.fill(0.0);
}

FundamentalEstimate VibrationAnalysis::fundamental(const Spectrum& lines) const {
    const Comb comb = fit_comb(lines, settings_.lowest, settings_.highest);
    FundamentalEstimate out{comb.best.frequency, comb.confidence,     true,
                            comb.best.frequency, comb.best.frequency, {comb.others().begin(), comb.others().end()}};
    std::vector<Second> heard;
    for (const Second& second : seconds_)
        if (second.frequency > 0.0) heard.push_back(second);
    if (heard.size() < 2) return out;
    std::sort(heard.begin(), heard.end(), [](const Second& a, const Second& b) { return a.frequency < b.frequency; });
    const auto share_near = [&](double frequency, double ratio) {
        double near = 0.0, all = 1e-30;
        for (const Second& second : seconds_) {
            const double weight = std::max(second.confidence, 0.1);
            all += weight;
            if (second.frequency > 0.0 && std::abs(second.frequency / frequency - 1.0) < ratio) near += weight;
        }
        return near / all;
    };
    if (out.frequency > 0.0 && share_near(out.frequency, 0.01) >= 0.7) {
        out.confidence =
            std::max(out.confidence, std::min(1.0, out.confidence + 0.5 * share_near(out.frequency, 0.01) - 0.35));
        return out;
    }
    // With a varying rate the spectrum of the whole record smears the lines; those of short sections do not.
    double all = 0.0, sum = 0.0, trust = 0.0;
    for (const Second& second : heard) all += second.confidence;
    for (const Second& second : heard) {
        trust += second.confidence * second.confidence / all;
        if (sum < 0.1 * all) out.low = second.frequency;
        if (sum < 0.5 * all) out.frequency = second.frequency;
        if (sum < 0.9 * all) out.high = second.frequency;
        sum += second.confidence;
    }
    out.steady = false;
    const double heard_share = static_cast<double>(heard.size()) / static_cast<double>(seconds_.size());
    out.confidence = trust * share_near(out.frequency, 0.1) * heard_share;
    if (comb.best.frequency > 0.0 && std::abs(comb.best.frequency / out.frequency - 1.0) > 0.02)
        out.rivals.insert(out.rivals.begin(), comb.best);
    return out;
}

VibrationReport VibrationAnalysis::report() const {
    VibrationReport out;
    out.level = level_;
    out.lines = lines_.spectrum();
    out.psd = psd_ ? psd_->spectrum() : out.lines;
    out.spectrogram = spectrogram_;
    if (out.lines.power.size() < 8) return out;
    out.fundamental = fundamental(out.lines);
    // Noise reaches lower confidences than this.
    if (out.fundamental.confidence < 0.1) out.fundamental.frequency = 0.0;
    out.harmonics = harmonic_table(out.lines, out.fundamental.frequency, settings_.orders);
    out.peaks = strongest(find_lines(out.lines, 2.0 * out.lines.df, settings_.psd.rate));
    out.hum = find_hum(out.lines, out.fundamental.frequency);
    out.bands = third_octaves(out.lines);
    if (envelope_spectrum_) {
        const Spectrum envelope = envelope_spectrum_->spectrum();
        const double highest = 0.5 * (settings_.envelope->second - settings_.envelope->first);
        out.envelope = strongest(find_lines(envelope, 2.0 * envelope.df, highest));
    }
    return out;
}

}  // namespace tactus::signal

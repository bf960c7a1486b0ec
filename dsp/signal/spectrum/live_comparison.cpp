// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/live_comparison.hpp"

#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/comparison.hpp"
#include "dsp/signal/spectrum/similarity.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr double coarse_s = 0.128, fine_s = 0.512;  // segments
constexpr std::size_t enough = 2;                   // fine segments
constexpr double no_power = 1e-20;                   // mean square, unit²

std::size_t segment(double rate, double seconds) {
    return std::max<std::size_t>(16, static_cast<std::size_t>(std::lround(rate * seconds)));
}

}  // namespace

LiveComparison::Heard::Heard(double rate, double memory)
    : coarse(rate, segment(rate, coarse_s), memory), fine(rate, segment(rate, fine_s), memory) {}

LiveComparison::LiveComparison(double reference_rate, double output_rate, double memory)
    : reference_(reference_rate, memory),
      output_(output_rate, memory),
      highest_(std::min(1000.0, 0.45 * std::min(reference_rate, output_rate))) {}

int LiveComparison::push_reference(std::span<const float> samples) noexcept {
    return reference_.coarse.push(samples) + reference_.fine.push(samples);
}

int LiveComparison::push_output(std::span<const float> samples) noexcept {
    return output_.coarse.push(samples) + output_.fine.push(samples);
}

LiveScores LiveComparison::scores() const noexcept {
    LiveScores scores;
    const Spectrum &r = reference_.fine.spectrum(), &d = output_.fine.spectrum();
    if (r.segments < enough || d.segments < enough) return scores;
    const double reference_power = band_power(r, min_frequency, highest_),
                 output_power = band_power(d, min_frequency, highest_);
    if (!(reference_power > no_power && output_power > no_power)) return scores;
    scores.heard = true;
    scores.gain_db = 10.0 * std::log10(reference_power / output_power);
    const double gain = std::sqrt(reference_power / output_power);
    const Spectrum &rough = reference_.coarse.spectrum(), &played = output_.coarse.spectrum();
    const SpectrumPair coarse{rough.power, played.power, rough.df};
    scores.lsd_db = log_spectral_distance(coarse, min_frequency, std::min(touch_end, highest_), gain);
    scores.cosine_500 = spectral_cosine(coarse, min_frequency, std::min(touch_end, highest_));
    scores.third_octave_max_db = third_octave_max_error({r.power, d.power, r.df}, min_frequency, highest_, gain);
    return scores;
}

}  // namespace tactus::signal

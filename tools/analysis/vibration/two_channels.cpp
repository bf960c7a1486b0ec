// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/two_channels.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tactus::analysis {

namespace {

constexpr std::size_t max_peaks = 5;
constexpr double min_coherence = 0.8;
constexpr double lobe_bins = 4.0;  // of a Hann window

/// Slope of the phase over frequency between neighbouring bins, weighted by power and coherence: −∠ΣPxy[k+1] conj
/// Pxy[k].
double delay_of(const TwoChannels& found) {
    std::complex<double> sum = 0.0;
    for (std::size_t k = 1; k + 1 < found.coherence.size(); ++k)
        if (found.coherence[k] > 0.9 && found.coherence[k + 1] > 0.9)
            sum += found.h1[k + 1] * std::conj(found.h1[k]) / (std::abs(found.h1[k + 1]) * std::abs(found.h1[k]));
    return std::abs(sum) > 0.0 ? -std::arg(sum) / (2.0 * pi * found.spectra.df) : 0.0;
}

/// Whether the response is lower at `there` than at `here` by 1 dB and by six standard deviations of the difference:
/// noise makes maxima and dips everywhere, and a dip between ripples is as uncertain as its coherence is low.
bool stands_above(const TwoChannels& found, std::size_t here, std::size_t there) {
    const std::vector<std::complex<double>>& h = found.chosen();
    const double fall = 20.0 * std::log10(std::abs(h[here]) / std::max(std::abs(h[there]), 1e-300));
    const double deviation = std::hypot(found.deviation[here], found.deviation[there]);
    return fall > std::max(1.0, 6.0 * 20.0 / std::log(10.0) * deviation);
}

/// Bins from a peak at bin k to half its power on one side; none if the response rises to a neighbour or ends before.
std::optional<double> half_width(const TwoChannels& found, std::size_t k, int step) {
    const std::vector<std::complex<double>>& h = found.chosen();
    const double half = std::abs(h[k]) / std::sqrt(2.0);
    std::size_t lowest = k;
    for (std::size_t i = k; i > 0 && i + 1 < h.size();) {
        const double inside = std::abs(h[i]);
        i = step < 0 ? i - 1 : i + 1;
        const double here = std::abs(h[i]);
        const auto away = static_cast<double>(i > k ? i - k : k - i);
        if (here <= half) return away - (half - here) / (inside - here);
        if (stands_above(found, i, lowest)) return std::nullopt;
        if (here < std::abs(h[lowest])) lowest = i;
    }
    return std::nullopt;
}

/// Mean coherence of `count` bins beyond a distance from bin k, on one side.
double coherence_beyond(const TwoChannels& found, std::size_t k, int step, double distance, double count) {
    double sum = 0.0, bins = 0.0;
    auto i = static_cast<std::ptrdiff_t>(k) + step * static_cast<std::ptrdiff_t>(std::ceil(distance));
    for (; bins < count && i > 0 && i < static_cast<std::ptrdiff_t>(found.coherence.size()); ++bins, i += step)
        sum += found.coherence[static_cast<std::size_t>(i)];
    return bins > 0.0 ? sum / bins : 0.0;
}

/// Sets the width of a peak at bin k, and whether the segments are too short for it: then it is narrow, or the
/// coherence dips. Over a resonance that they resolve it does not, since the output is strongest there. False for a
/// peak without a coherence of `min_coherence` at or beside it.
bool measure_width(ResponsePeak& peak, const TwoChannels& found, std::size_t k) {
    const std::array<std::optional<double>, 2> sides{half_width(found, k, -1), half_width(found, k, 1)};
    double beside = 1.0, beyond = 1.0;  // the lower of the mean coherences on both sides: next to it, and farther away
    bool has_side = false;
    for (std::size_t side = 0; side < 2; ++side) {
        // A peak beside another one is as wide as its free side.
        const std::optional<double> reach = sides[side] ? sides[side] : sides[1 - side];
        peak.bins += reach.value_or(0.0);
        if (!sides[side]) continue;
        has_side = true;
        const int step = side == 0 ? -1 : 1;
        beside = std::min(beside, coherence_beyond(found, k, step, *reach, std::floor(*reach) + 1.0));
        beyond = std::min(beyond, coherence_beyond(found, k, step, *reach + lobe_bins, lobe_bins));
    }
    // Standard deviation of a coherence: √(2γ²(1−γ²)²/K).
    const double here = found.coherence[k],
                 deviation = (1.0 - here) * std::sqrt(2.0 * here / found.spectra.effective_segments);
    peak.is_smeared = has_side && (peak.bins < min_peak_bins || std::max(beside, beyond) - here > 4.0 * deviation);
    return here >= min_coherence || (peak.is_smeared && beyond >= min_coherence);
}

std::vector<ResponsePeak> peaks_of(const TwoChannels& found) {
    const std::vector<std::complex<double>>& h = found.chosen();
    std::vector<ResponsePeak> peaks;
    for (std::size_t k = 1; k + 1 < h.size(); ++k) {
        const double here = std::abs(h[k]);
        if (found.spectra.frequency(k) > found.usable) break;
        if (here < std::abs(h[k - 1]) || here <= std::abs(h[k + 1])) continue;
        const auto falls = [&](int step) {
            for (auto i = static_cast<std::ptrdiff_t>(k) + step; i > 0 && i < static_cast<std::ptrdiff_t>(h.size());
                 i += step) {
                const auto at = static_cast<std::size_t>(i);
                if (std::abs(h[at]) > here) return false;
                if (stands_above(found, k, at)) return true;
            }
            return false;
        };
        if (!falls(-1) || !falls(1)) continue;
        ResponsePeak peak;
        peak.hz = found.spectra.frequency(k);
        peak.level_db = 20.0 * std::log10(here);
        peak.phase = std::arg(h[k]);
        peak.coherence = found.coherence[k];
        peak.deviation_db = 20.0 / std::log(10.0) * found.deviation[k];
        if (measure_width(peak, found, k)) peaks.push_back(peak);
    }
    std::ranges::stable_sort(peaks, std::greater<>(), &ResponsePeak::level_db);
    if (peaks.size() > max_peaks) peaks.resize(max_peaks);
    std::ranges::sort(peaks, {}, &ResponsePeak::hz);
    return peaks;
}

}  // namespace

const std::vector<std::complex<double>>& TwoChannels::chosen() const {
    return estimator == Estimator::h1 ? h1 : estimator == Estimator::h2 ? h2 : hv;
}

TwoChannels analyse_two_channels(const std::filesystem::path& file, const ResponseSettings& settings,
                                 const std::function<void(double)>& progress) {
    sound::RecordReader reader = open_record(file, settings.record);
    const std::vector<std::size_t> chosen = chosen_channels(reader, file, settings.record);
    if (chosen.size() != 2)
        throw Error(
            fmt::format("{}: a response is between two channels, input and output; name them with --channel, as in "
                        "--channel 1,2 (the record has {})",
                        file.string(), reader.channels().size()));
    TwoChannels out;
    out.input = reader.channels()[chosen[0]];
    out.output = reader.channels()[chosen[1]];
    out.rate = reader.rate();
    out.usable = reader.log() ? std::min(0.5 * out.rate, reader.log()->usable) : 0.5 * out.rate;
    out.calibration = reader.calibration();
    out.log = reader.log();
    out.stretch = reader.stretch();
    out.estimator = settings.estimator;
    const std::size_t frames = std::max<std::size_t>(1, reader.frames());
    out.welch.rate = out.rate;
    out.welch.window = settings.window;
    out.welch.segment = settings.segment.value_or(signal::suggested_segment(out.rate, frames));
    out.welch.overlap = std::min(out.welch.segment - 1,
                                 static_cast<std::size_t>(settings.overlap * static_cast<double>(out.welch.segment)));
    signal::CrossStream<double> stream(out.welch);
    sound::RecordBlock block;
    std::size_t done = 0;
    while (reader.next(block)) {
        if (block.after_gap) stream.forget_waiting();
        stream.push(block.channels[chosen[0]], block.channels[chosen[1]]);
        done += block.size();
        if (progress) progress(static_cast<double>(done) / static_cast<double>(frames));
    }
    out.duration = static_cast<double>(done) / out.rate;
    out.spectra = stream.spectra();
    if (out.spectra.segments < 4)
        throw Error(
            fmt::format("{}: coherence needs at least 4 segments, there are {} of {} samples; take shorter ones with "
                        "--segment",
                        file.string(), out.spectra.segments, out.welch.segment));
    out.h1 = out.spectra.h1();
    out.h2 = out.spectra.h2();
    out.hv = out.spectra.hv();
    out.coherence = out.spectra.coherence();
    out.deviation = out.spectra.response_deviation();
    out.noise_coherence = 1.0 / out.spectra.effective_segments;
    out.delay = delay_of(out);
    out.peaks = peaks_of(out);
    return out;
}

}  // namespace tactus::analysis

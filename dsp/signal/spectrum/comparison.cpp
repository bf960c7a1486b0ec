// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/comparison.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/signal/filter/resample.hpp"
#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/cross.hpp"
#include "dsp/signal/spectrum/decibels.hpp"
#include "dsp/signal/spectrum/fundamental.hpp"
#include "dsp/signal/spectrum/level.hpp"
#include "dsp/signal/spectrum/mains.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::signal {

namespace {

constexpr double rate = 8000.0;  // Hz: the comparison uses frequencies below 1 kHz
constexpr double shortest = 0.5, stretch = 60.0;  // s: minimum length of a take; length used for alignment
constexpr double silence = 1e-5;  // of the peak
// Segments for distance and cosine, coherence, bands, lines.
constexpr std::size_t coarse = 1024, middle = 2048, fine = 4096, sharp = 8192;
constexpr double speed_range = 0.03;
constexpr double max_order_gap_db = 6.0;  // beyond it an order is in one take only
constexpr double min_coherence = 0.5;  // of copies; other takes are compared by their statistics over time

/// A take resampled to the common rate, in pieces.
class Stream {
public:
    /// `start`: s, position in the take. `speed`: ratio of the take's speed to the wanted one.
    Stream(const Take& take, double start, double speed = 1.0)
        : blocks_(take.open()), resampling_(take.frames, take.rate / speed, rate, start) {}

    std::size_t size() const { return resampling_.frames(); }
    /// The next `most` samples; fewer at the end only. Valid until the next call.
    std::span<const double> next(std::size_t most) {
        ready_.erase(ready_.begin(), ready_.begin() + static_cast<std::ptrdiff_t>(given_));
        while (ready_.size() < most) {
            const std::span<const double> block = blocks_();
            if (block.empty()) break;
            resampling_.push(block, ready_);
        }
        given_ = std::min(most, ready_.size());
        return {ready_.data(), given_};
    }

private:
    Take::Blocks blocks_;
    ResamplingStream resampling_;
    std::vector<double> ready_;
    std::size_t given_ = 0;
};

double variance(std::span<const double> samples) {
    double mean = 0.0, square = 0.0;
    for (const double x : samples) mean += x / static_cast<double>(samples.size());
    for (const double x : samples) square += (x - mean) * (x - mean);
    return square / static_cast<double>(samples.size());
}

/// The same section of both takes.
struct Stretch {
    std::vector<double> reference, output;
};

/// The loudest of consecutive sections of `length` samples; all of takes that are shorter.
Stretch loudest_stretch(const Take& reference, const Take& output, std::size_t length) {
    Stream r(reference, 0.0), d(output, 0.0);
    Stretch best;
    for (double most = -1.0;;) {
        const std::span<const double> a = r.next(length), b = d.next(length);
        const bool whole = a.size() == length && b.size() == length;
        if (most < 0.0 || (whole && variance(a) * variance(b) > most)) {
            most = whole ? variance(a) * variance(b) : 0.0;
            best = {{a.begin(), a.end()}, {b.begin(), b.end()}};
        }
        if (!whole) return best;
    }
}

/// The takes to compare: from their common start on, the output with the reference's polarity and speed.
struct Pair {
    const Take& reference;
    const Take& output;
    double reference_start = 0.0, output_start = 0.0;  // s
    double speed = 1.0, sign = 1.0;
    std::size_t common = 0;  // samples of both; 0: all of each

    std::size_t reference_size() const { return size_of(Stream(reference, reference_start)); }
    std::size_t output_size() const { return size_of(Stream(output, output_start, speed)); }
    WelchSettings settings(std::size_t segment) const {
        // The shorter take has four segments.
        const std::size_t longest = std::bit_floor(std::min(reference_size(), output_size()) / 4);
        WelchSettings settings;
        settings.rate = rate;
        settings.segment = std::min(segment, longest);
        settings.overlap = settings.segment / 2;
        return settings;
    }
    /// Calls `use` with equally long pieces of both until one ends.
    template <class Use>
    void read(const Use& use) const {
        Stream r(reference, reference_start), d(output, output_start, speed);
        std::vector<double> turned;
        constexpr std::size_t piece = 8192;
        for (std::size_t done = 0; common == 0 || done < common; done += piece) {
            const std::size_t most = common == 0 ? piece : std::min(piece, common - done);
            const std::span<const double> a = r.next(most), b = d.next(most);
            if (a.empty() && b.empty()) return;
            turned.assign(b.begin(), b.end());
            for (double& x : turned) x *= sign;
            use(a, std::span<const double>(turned));
        }
    }

private:
    std::size_t size_of(const Stream& stream) const { return common == 0 ? stream.size() : common; }
};

void add(Spectrum& sum, const Spectrum& one) {
    if (sum.power.empty()) {
        sum = one;
        return;
    }
    for (std::size_t k = 0; k < sum.power.size(); ++k) sum.power[k] += one.power[k];
}

/// A spectrum of each.
struct SpectraOfBoth {
    WelchStream<double> reference, output;
    explicit SpectraOfBoth(const WelchSettings& settings) : reference(settings), output(reference) {}
    void push(std::span<const double> r, std::span<const double> d) {
        reference.push(r);
        output.push(d);
    }
};

/// Takes of one axis each, with the same start and speed. The first pair is the one whose waveforms are compared.
using Axes = std::span<const Pair>;

/// Spectra with the powers of all axes added, the root sum of squares of their amplitudes.
std::pair<Spectrum, Spectrum> spectra_of(Axes axes, std::size_t segment) {
    std::pair<Spectrum, Spectrum> sum;
    for (const Pair& axis : axes) {
        SpectraOfBoth both(axes.front().settings(segment));
        axis.read([&](std::span<const double> r, std::span<const double> d) { both.push(r, d); });
        add(sum.first, both.reference.spectrum());
        add(sum.second, both.output.spectrum());
    }
    return sum;
}

/// Power in the band. Throws Error if it is negligible relative to the peak, as of a constant.
double power_in_band(double peak, const Spectrum& density, const Comparison& result, const char* name) {
    const double power = band_power(density, result.lowest, result.highest);
    if (!(std::sqrt(power) > silence * peak))
        throw Error(fmt::format("the {} is silent from {:g} to {:g} Hz", name, result.lowest, result.highest));
    return power;
}

FundamentalEstimate fundamental_of(const Take& take) {
    FundamentalStream stream(take.rate, take.frames);
    const Take::Blocks blocks = take.open();
    for (std::span<const double> block = blocks(); !block.empty(); block = blocks()) stream.push(block);
    return stream.estimate();
}

/// Whether two takes have the same orders at these rates: each at least 2, and none that the other lacks.
bool have_same_orders(const Spectrum& reference, double reference_hz, const Spectrum& output, double output_hz,
                      double highest) {
    constexpr double lacks = std::numeric_limits<double>::infinity();
    return harmonic_error(reference, reference_hz, output, output_hz, highest).value_or(lacks) <= max_order_gap_db &&
           harmonic_error(output, output_hz, reference, reference_hz, highest).value_or(lacks) <= max_order_gap_db;
}

/// Sets the fundamentals of both takes, and the rates that may be hum. A certain rate in the other take settles that a
/// rate near it is the saw's: hum does not follow the speed of a saw. Not if that rate is at the mains too, nor if the
/// orders differ: hum in one take is not the saw in the other.
void find_fundamentals(const Take& reference, const Take& output, const Spectrum& sharp_reference,
                       const Spectrum& sharp_output, Comparison& result) {
    const FundamentalEstimate r = fundamental_of(reference), d = fundamental_of(output);
    const auto is_of_saw = [&](const FundamentalEstimate& own, const FundamentalEstimate& other) {
        return own.may_be_hum && other.is_certain() && !is_mains_order(other.frequency) &&
               std::abs(own.frequency / other.frequency - 1.0) < speed_range &&
               have_same_orders(sharp_reference, r.frequency, sharp_output, d.frequency, result.highest);
    };
    const auto set = [&](const FundamentalEstimate& own, const FundamentalEstimate& other, double& hz, double& hum_hz) {
        if (own.is_certain() || is_of_saw(own, other)) hz = own.frequency;
        else if (own.may_be_hum) hum_hz = own.frequency;
    };
    set(r, d, result.reference_hz, result.reference_hum_hz);
    set(d, r, result.output_hz, result.output_hum_hz);
}

/// A power in the band as a fraction of the variance of the take at its own sample rate.
double fraction_inside(const Take& take, double power) {
    Level level;
    const Take::Blocks blocks = take.open();
    for (std::span<const double> block = blocks(); !block.empty(); block = blocks()) level.push(block);
    return level.rms() > 0.0 ? std::min(1.0, power / (level.rms() * level.rms())) : 0.0;
}

double peak_of(double before, std::span<const double> samples) {
    for (const double x : samples) before = std::max(before, std::abs(x));
    return before;
}

void score_spectra(Axes axes, const ComparisonOptions& options, SpectrogramSimilarity& spectrograms,
                   Comparison& result) {
    double reference_peak = 0.0, output_peak = 0.0;
    axes.front().read([&](std::span<const double> r, std::span<const double> d) {
        const std::size_t both = std::min(r.size(), d.size());
        spectrograms.push(r.first(both), d.first(both));
        reference_peak = peak_of(reference_peak, r);
        output_peak = peak_of(output_peak, d);
    });
    spectrograms.end_of_pass();
    const auto [fine_reference, fine_output] = spectra_of(axes, fine);
    const auto [a, b] = spectra_of(axes, coarse);
    const double low = result.lowest, high = result.highest;
    const double reference_power = power_in_band(reference_peak, fine_reference, result, "reference");
    const double output_power = power_in_band(output_peak, fine_output, result, "output");
    result.reference_rms = std::sqrt(reference_power);
    result.output_rms = std::sqrt(output_power);
    result.gain_db = decibels(reference_power / output_power);
    const double gain = std::sqrt(reference_power / output_power);

    const SpectrumPair powers{a.power, b.power, a.df};
    result.lsd_db = log_spectral_distance(powers, low, result.touched(), gain);
    result.cosine_500 = spectral_cosine(powers, low, result.touched());
    result.cosine_1000 = spectral_cosine(powers, low, high);
    result.touch_cosine = spectral_cosine(powers, low, high, options.touch);
    double perceived_reference = 0.0, perceived_output = 0.0;
    for (std::size_t k = 0; k < a.power.size(); ++k) {
        const double f = a.frequency(k);
        if (f < low || f > high) continue;
        const double weight = std::pow(10.0, 0.1 * touch_weight_db(f, options.touch));
        perceived_reference += weight * a.power[k];
        perceived_output += weight * gain * gain * b.power[k];
    }
    result.touch_gap_db = decibels(perceived_output / perceived_reference);

    // Bands that extend beyond the valid range are left out, except that of 1000 Hz.
    const double last_centre = high < 0.999 * max_frequency ? high / std::pow(10.0, 0.05) : high;
    result.third_octaves =
        third_octave_errors({fine_reference.power, fine_output.power, fine_reference.df}, low, last_centre, gain);
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

void score_over_time(const Pair& pair, SpectrogramSimilarity& spectrograms, Comparison& result) {
    std::optional<WaveformSimilarity> waveforms;
    std::optional<CrossStream<double>> crossed;
    if (result.alignment.significant) {
        waveforms.emplace();
        crossed.emplace(pair.settings(middle));
    }
    std::vector<double> equally_strong;
    Course reference(rate, result.lowest, result.highest), output(reference);
    pair.read([&](std::span<const double> r, std::span<const double> d) {
        reference.push(r);
        output.push(d);
        const std::size_t both = std::min(r.size(), d.size());
        spectrograms.push(r.first(both), d.first(both));
        if (!waveforms) return;
        equally_strong.assign(d.begin(), d.end());
        for (double& x : equally_strong) x *= result.reference_rms / result.output_rms;
        waveforms->push(r, equally_strong);
        crossed->push(r, d);
    });
    spectrograms.end_of_pass();
    result.spectrogram_similarity = spectrograms.value();
    result.reference_kurtosis = CourseStatistics(reference.frames()).kurtosis();
    result.output_kurtosis = CourseStatistics(output.frames()).kurtosis();
    result.statistics = statistics_difference(reference.frames(), output.frames());
    if (!waveforms) return;
    // These scores use all frequencies of the waveforms, so both takes must be valid up to 1 kHz.
    if (result.highest >= 0.999 * max_frequency) {
        result.st_sim = waveforms->st_sim();
        result.spqi = waveforms->spqi();
        result.signal_to_noise_db = waveforms->signal_to_noise_db();
    }
    const CrossSpectra cross = crossed->spectra();
    result.coherence = cross.coherence();
    result.coherence_step = cross.df;
    // Averaged over bins with signal in the reference: between its lines there is unrelated noise.
    double greatest = 0.0, sum = 0.0, count = 0.0;
    const auto in_band = [&](std::size_t k) {
        return cross.frequency(k) >= result.lowest && cross.frequency(k) <= result.highest;
    };
    for (std::size_t k = 0; k < cross.xx.size(); ++k)
        if (in_band(k)) greatest = std::max(greatest, cross.xx[k]);
    for (std::size_t k = 0; k < cross.xx.size(); ++k)
        if (in_band(k) && cross.xx[k] > 1e-4 * greatest) sum += result.coherence[k], count += 1.0;
    result.coherence_mean = count > 0.0 ? sum / count : 0.0;
    if (*result.coherence_mean > min_coherence) {
        result.course_db = course_difference_db(reference.frames(), output.frames());
        result.statistics.reset();
    }
}

/// Whether the aligned stretches are coherent in any third of an octave, beyond what unrelated noise shows by chance.
bool is_coherent(const Stretch& loud, const Comparison& result) {
    const auto lag = static_cast<std::ptrdiff_t>(std::llround(result.alignment.delay * rate));
    const auto from = [](const std::vector<double>& all, std::ptrdiff_t first) {
        return std::span(all).subspan(
            std::min(all.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, first))));
    };
    const std::span<const double> r = from(loud.reference, -lag), d = from(loud.output, lag);
    const std::size_t common = std::min(r.size(), d.size());
    CrossStream<double> crossed(WelchSettings::hann(rate, middle, middle / 2));
    crossed.push(r.first(common), d.first(common));
    const CrossSpectra cross = crossed.spectra();
    if (cross.segments < 4) return true;
    const std::vector<double> coherence = cross.coherence();
    // The coherence of unrelated noise has a mean of 1/K, and nearly that as its standard deviation.
    const double chance = 1.0 / cross.effective_segments;
    for (double low = result.lowest; low < result.highest; low *= std::cbrt(2.0)) {
        double sum = 0.0, count = 0.0;
        for (std::size_t k = 0; k < coherence.size(); ++k)
            if (const double f = cross.frequency(k); f >= low && f < std::min(low * std::cbrt(2.0), result.highest))
                sum += coherence[k], count += 1.0;
        // A Hann window makes neighbouring bins dependent.
        if (count > 0.0 && sum / count > chance * (1.0 + 6.0 * std::sqrt(2.0 / count))) return true;
    }
    return false;
}

template <class Sample>
Take::Blocks blocks_of(std::span<const Sample> samples) {
    return [samples, buffer = std::vector<double>()]() mutable -> std::span<const double> {
        const std::size_t count = std::min<std::size_t>(samples.size(), 65536);
        buffer.assign(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count));
        samples = samples.subspan(count);
        return buffer;
    };
}

}  // namespace

Take::Take(std::span<const float> samples, double sample_rate)
    : Take(sample_rate, samples.size(), [samples] { return blocks_of(samples); }) {}

Take::Take(std::span<const double> samples, double sample_rate)
    : Take(sample_rate, samples.size(), [samples] { return blocks_of(samples); }) {}

Comparison compare(const Take& reference, const Take& output, const ComparisonOptions& options) {
    Comparison result;
    result.highest = std::min({max_frequency, reference.usable, output.usable});
    if (!(result.highest >= narrowest_band)) {
        const bool first = reference.usable < output.usable;
        throw Error(
            fmt::format("the {}, sampled at {}, can be trusted to {:.3g} Hz only: vibrations are compared from "
                        "{:g} Hz on, at least to {:g} Hz",
                        first ? "reference" : "output", readable(first ? reference.rate : output.rate, "Hz", 6),
                        result.highest, min_frequency, narrowest_band));
    }
    result.end = 0.5 * std::min({rate, reference.rate, output.rate});
    for (const auto& [take, name] : {std::pair(&reference, "reference"), std::pair(&output, "output")})
        if (static_cast<double>(take->frames) < shortest * take->rate)
            throw Error(fmt::format("the {} is shorter than {} s", name, shortest));
    const auto length = static_cast<std::size_t>(rate * stretch);
    const Stretch loud = loudest_stretch(reference, output, length);
    result.alignment =
        align_takes(loud.reference, loud.output, rate, result.lowest, result.highest, options.longest_delay);

    // Slow modulation of both takes causes high chance peaks of the correlation. Takes that were recorded together are
    // coherent in some band.
    if (result.alignment.significant && !is_coherent(loud, result)) result.alignment = {};

    // A take that fits in memory is not read again.
    const auto kept = [&](const Take& take, const std::vector<double>& samples) {
        return Stream(take, 0.0).size() == samples.size() ? Take(std::span<const double>(samples), rate) : take;
    };
    const Take r = kept(reference, loud.reference), d = kept(output, loud.output);
    Pair pair{r, d};
    if (result.alignment.significant) {
        pair.reference_start = std::max(0.0, -result.alignment.delay);
        pair.output_start = std::max(0.0, result.alignment.delay);
        pair.sign = result.alignment.correlation < 0.0 ? -1.0 : 1.0;
        pair.common = std::min(pair.reference_size(), pair.output_size());
    }
    std::vector<Pair> axes{pair};
    for (std::size_t i = 0; i < std::min(options.reference_axes.size(), options.output_axes.size()); ++i)
        axes.push_back({options.reference_axes[i], options.output_axes[i], pair.reference_start, pair.output_start, 1.0,
                        pair.sign, pair.common});
    const auto [sharp_reference, sharp_output] = spectra_of(axes, sharp);
    find_fundamentals(reference, output, sharp_reference, sharp_output, result);
    const double ratio = result.output_hz / result.reference_hz;
    const bool one_saw = std::abs(ratio - 1.0) < speed_range;
    // The output is resampled to the reference's rate if both rates are known and similar.
    if (one_saw && !result.alignment.significant && std::abs(ratio - 1.0) >= 1e-5)
        for (Pair& axis : axes) axis.speed = result.speed_ratio = ratio;
    SpectrogramSimilarity spectrograms(rate, result.lowest, result.highest);
    score_spectra(axes, options, spectrograms, result);
    score_over_time(axes.front(), spectrograms, result);
    if (axes.size() == 1) {
        result.reference_inside = fraction_inside(reference, result.reference_rms * result.reference_rms);
        result.output_inside = fraction_inside(output, result.output_rms * result.output_rms);
    }
    // The orders of saws at different speeds are compared, each at the rate of its take.
    result.harmonic_error_db = harmonic_error(sharp_reference, result.reference_hz, sharp_output,
                                              one_saw ? result.output_hz : result.reference_hz, result.highest);
    result.lines = match_lines(sharp_reference, sharp_output, std::pow(10.0, result.gain_db / 20.0), result.speed_ratio,
                               result.lowest, result.highest);
    result.above_noise = above_noise(sharp_reference, sharp_output, result.lines, result.lowest, result.highest);
    return result;
}

}  // namespace tactus::signal

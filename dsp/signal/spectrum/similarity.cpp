// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/similarity.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/decibels.hpp"
#include "dsp/signal/spectrum/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::signal {

namespace {

constexpr double floor_ratio = 1e-4;  // −40 dB

struct Bins {
    std::size_t first, end;
};

Bins bins_of(const SpectrumPair& pair, double lowest, double highest) {
    const std::size_t size = std::min(pair.reference.size(), pair.output.size());
    const auto at = [&](double bin) {
        return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(size)));
    };
    return {at(std::ceil(lowest / pair.step - 1e-9)), at(std::floor(highest / pair.step + 1e-9) + 1.0)};
}

template <class Block>
Block support(const Block& levels) {
    Block out;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = 0.5 * std::erfc(-levels[k] / 12.0 / std::numbers::sqrt2);
    return out;
}

template <class Block>
Block standardised(const Block& samples) {
    const auto count = static_cast<double>(samples.size());
    double mean = 0.0, square = 0.0;
    for (const double x : samples) mean += x / count;
    for (const double x : samples) square += (x - mean) * (x - mean) / count;
    Block out;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = (samples[k] - mean) / (std::sqrt(square) + 1e-300);
    return out;
}

/// Projection coefficient of the output on the reference. A silent reference has none: it is like a silent
/// output, and like no other.
template <class Block>
double likeness(const Block& reference, const Block& output) {
    double product = 0.0, power = 0.0, other = 0.0;
    for (std::size_t k = 0; k < reference.size(); ++k) {
        product += reference[k] * output[k];
        power += reference[k] * reference[k];
        other += output[k] * output[k];
    }
    if (!(power > 0.0)) return other > 0.0 ? 0.0 : 1.0;
    return product / power;
}

WaveformSimilarity similarity_of(std::span<const double> reference, std::span<const double> output) {
    const std::size_t common = std::min(reference.size(), output.size());
    WaveformSimilarity similarity;
    similarity.push(reference.first(common), output.first(common));
    return similarity;
}

template <class Use>
void each_band_error(const SpectrumPair& pair, double lowest, double highest, double gain, const Use& use) {
    // 0.5 % tolerance: the nominal 40 Hz band has its exact centre at 39.8 Hz.
    const int first = static_cast<int>(std::ceil(10.0 * std::log10(lowest * 0.99)));
    const int last = static_cast<int>(std::floor(10.0 * std::log10(highest * 1.01)));
    const auto level = [&](std::span<const double> density, int n) {
        return band_power(density, pair.step, std::pow(10.0, n / 10.0 - 0.05), std::pow(10.0, n / 10.0 + 0.05));
    };
    double greatest = 0.0;
    for (int n = first; n <= last; ++n) greatest = std::max(greatest, level(pair.reference, n));
    for (int n = first; n <= last; ++n) {
        const double reference = level(pair.reference, n);
        if (!(reference > floor_ratio * greatest)) continue;
        const double output = gain * gain * level(pair.output, n);
        use(BandError{std::pow(10.0, n / 10.0), decibels(std::max(output / reference, 1e-6))});
    }
}

}  // namespace

double log_spectral_distance(const SpectrumPair& pair, double lowest, double highest, double gain) {
    const Bins bins = bins_of(pair, lowest, highest);
    double greatest = 0.0;
    for (std::size_t k = bins.first; k < bins.end; ++k) greatest = std::max(greatest, pair.reference[k]);
    if (!(greatest > 0.0)) return 0.0;
    const double least = floor_ratio * greatest;
    double sum = 0.0;
    for (std::size_t k = bins.first; k < bins.end; ++k) {
        const double error =
            decibels(std::max(pair.reference[k], least) / std::max(gain * gain * pair.output[k], least));
        sum += error * error;
    }
    return std::sqrt(sum / static_cast<double>(bins.end - bins.first));
}

double spectral_cosine(const SpectrumPair& pair, double lowest, double highest, ThresholdUnit unit) {
    const Bins bins = bins_of(pair, lowest, highest);
    double product = 0.0, reference = 0.0, output = 0.0;
    for (std::size_t k = bins.first; k < bins.end; ++k) {
        const double weight = std::pow(10.0, 0.1 * touch_weight_db(static_cast<double>(k) * pair.step, unit));
        product += weight * std::sqrt(pair.reference[k] * pair.output[k]);
        reference += weight * pair.reference[k];
        output += weight * pair.output[k];
    }
    return reference > 0.0 && output > 0.0 ? product / std::sqrt(reference * output) : 0.0;
}

std::vector<BandError> third_octave_errors(const SpectrumPair& pair, double lowest, double highest, double gain) {
    std::vector<BandError> errors;
    each_band_error(pair, lowest, highest, gain, [&](const BandError& error) { errors.push_back(error); });
    return errors;
}

double third_octave_max_error(const SpectrumPair& pair, double lowest, double highest, double gain) noexcept {
    double worst = 0.0;
    each_band_error(pair, lowest, highest, gain,
                    [&](const BandError& error) { worst = std::max(worst, std::abs(error.error_db)); });
    return worst;
}

WaveformSimilarity::WaveformSimilarity() {
    constexpr double rate = 8000.0;
    // As published: the grid runs from 0 to the rate inclusive, its lower half is used, and the values from the first
    // one above 0 on are held.
    for (std::size_t k = 0; k < block; ++k)
        threshold_[k] = k > 0 && threshold_[k - 1] > 0.0
                            ? threshold_[k - 1]
                            : touch_curve_db(rate * static_cast<double>(k) / (2.0 * block - 1.0));
}

/// Levels of the orthonormal discrete cosine transform above the tactile threshold, dB.
WaveformSimilarity::Block WaveformSimilarity::perceived(const Block& samples) const {
    const auto spectrum = spectrum_of(samples, 2 * block);
    Block levels;
    for (std::size_t k = 0; k < block; ++k) {
        const double turned = (spectrum[k] * std::polar(1.0, -pi * static_cast<double>(k) / (2.0 * block))).real();
        const double value = turned * std::sqrt((k == 0 ? 1.0 : 2.0) / block);
        levels[k] = 20.0 * std::log10(std::max(std::abs(value), 1e-30)) - threshold_[k];
    }
    return levels;
}

void WaveformSimilarity::take_block() {
    const Block r = perceived(reference_), d = perceived(output_);
    spectral_ += likeness(support(r), support(d));
    temporal_ += likeness(standardised(reference_), standardised(output_));
    double difference = 0.0, power = 0.0;
    for (std::size_t k = 0; k < block; ++k) {
        const double pr = std::pow(10.0, 0.1 * r[k]), pd = std::pow(10.0, 0.1 * d[k]);
        difference += std::abs(pr - pd);
        power += pr;
    }
    const double error = decibels(std::max(difference / (power + 2.2e-16), 1e-30));
    quality_ += 0.5 * (1.0 - std::tanh(0.3 * error + 2.0));
    ++blocks_;
}

void WaveformSimilarity::push(std::span<const double> reference, std::span<const double> output) {
    for (std::size_t i = 0; i < reference.size(); ++i) {
        signal_ += reference[i] * reference[i];
        noise_ += (reference[i] - output[i]) * (reference[i] - output[i]);
        reference_[held_] = reference[i];
        output_[held_] = output[i];
        if (++held_ < block) continue;
        take_block();
        held_ = 0;
    }
}

double WaveformSimilarity::st_sim() const {
    if (blocks_ == 0 || temporal_ <= 0.0) return 0.0;
    const auto count = static_cast<double>(blocks_);
    return std::min(1.0, std::pow(temporal_ / count, 2.0 / 3.0) * std::cbrt(spectral_ / count));
}

double WaveformSimilarity::spqi() const { return blocks_ > 0 ? quality_ / static_cast<double>(blocks_) : 0.0; }

double WaveformSimilarity::signal_to_noise_db() const {
    return decibels(std::max(signal_, 1e-300) / std::max(noise_, 1e-300));
}

double st_sim(std::span<const double> reference, std::span<const double> output) {
    return similarity_of(reference, output).st_sim();
}

double spqi(std::span<const double> reference, std::span<const double> output) {
    return similarity_of(reference, output).spqi();
}

double signal_to_noise_db(std::span<const double> reference, std::span<const double> output) {
    return similarity_of(reference, output).signal_to_noise_db();
}

double Pearson::value() const {
    const double vx = xx - x * x / n, vy = yy - y * y / n;
    return n > 0.0 && vx > 0.0 && vy > 0.0 ? (xy - x * y / n) / std::sqrt(vx * vy) : 0.0;
}

SpectrogramSimilarity::SpectrogramSimilarity(double rate, double lowest, double highest)
    : quarter_(static_cast<std::size_t>(std::max(2.0, std::round(rate * 1024.0 / 48000.0 / 4.0)))),
      reference_{SegmentFft<double>(4 * quarter_, WindowKind::hann, Detrend::none), {}, {}},
      output_(reference_) {
    const double step = rate / static_cast<double>(4 * quarter_);
    first_ = static_cast<std::size_t>(std::ceil(lowest / step));
    end_ = std::min(2 * quarter_, static_cast<std::size_t>(std::floor(highest / step))) + 1;
    for (Columns* columns : {&reference_, &output_})
        columns->waiting.resize((4 + SegmentFft<double>::lanes - 1) * quarter_);
}

void SpectrogramSimilarity::take(Columns& columns, std::size_t count) {
    std::array<const double*, SegmentFft<double>::lanes> starts{};
    for (std::size_t i = 0; i < count; ++i) starts[i] = columns.waiting.data() + i * quarter_;
    const Lanes<double>* spectrum = columns.transform({starts.data(), count});
    columns.powers.clear();
    for (std::size_t lane = 0; lane < count; ++lane)
        for (std::size_t k = first_; k < end_; ++k) {
            const double re = spectrum[2 * k][lane], im = spectrum[2 * k + 1][lane];
            columns.powers.push_back(re * re + im * im);
        }
}

void SpectrogramSimilarity::compare_columns() {
    if (!second_) {
        for (Columns* columns : {&reference_, &output_})
            for (const double power : columns->powers) columns->greatest = std::max(columns->greatest, power);
        return;
    }
    const double floor_r = std::max(floor_ratio * reference_.greatest, 1e-300),
                 floor_d = std::max(floor_ratio * output_.greatest, 1e-300);
    for (std::size_t i = 0; i < reference_.powers.size(); ++i)
        pearson_.add(decibels(std::max(reference_.powers[i], floor_r)), decibels(std::max(output_.powers[i], floor_d)));
}

void SpectrogramSimilarity::push(std::span<const double> reference, std::span<const double> output) {
    constexpr std::size_t lanes = SegmentFft<double>::lanes;
    while (!reference.empty()) {
        const std::size_t part = std::min(reference.size(), reference_.waiting.size() - reference_.held);
        std::copy_n(reference.begin(), part, reference_.waiting.begin() + static_cast<std::ptrdiff_t>(reference_.held));
        std::copy_n(output.begin(), part, output_.waiting.begin() + static_cast<std::ptrdiff_t>(output_.held));
        reference_.held = output_.held += part;
        reference = reference.subspan(part);
        output = output.subspan(part);
        if (reference_.held < reference_.waiting.size()) return;
        for (Columns* columns : {&reference_, &output_}) {
            take(*columns, lanes);
            std::copy(columns->waiting.begin() + static_cast<std::ptrdiff_t>(lanes * quarter_), columns->waiting.end(),
                      columns->waiting.begin());
            columns->held -= lanes * quarter_;
        }
        compare_columns();
    }
}

void SpectrogramSimilarity::end_of_pass() {
    if (reference_.held >= 4 * quarter_) {
        for (Columns* columns : {&reference_, &output_}) take(*columns, (columns->held - 4 * quarter_) / quarter_ + 1);
        compare_columns();
    }
    reference_.held = output_.held = 0;
    second_ = true;
}

double spectrogram_similarity(std::span<const double> reference, std::span<const double> output, double rate,
                              double lowest, double highest) {
    const std::size_t common = std::min(reference.size(), output.size());
    SpectrogramSimilarity similarity(rate, lowest, highest);
    for (int pass = 0; pass < 2; ++pass) {
        similarity.push(reference.first(common), output.first(common));
        similarity.end_of_pass();
    }
    return similarity.value();
}

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
#include "dsp/spectrum/similarity.hpp"

#include "dsp/spectrum/bands.hpp"
#include "dsp/spectrum/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus {

namespace {

constexpr double pi = std::numbers::pi;
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

double decibel(double power_ratio) { return 10.0 * std::log10(power_ratio); }

/// Correlation coefficient of what is added to it.
struct Pearson {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;

    void add(double a, double b) { n += 1.0, x += a, y += b, xx += a * a, yy += b * b, xy += a * b; }
    double value() const {
        const double vx = xx - x * x / n, vy = yy - y * y / n;
        return n > 0.0 && vx > 0.0 && vy > 0.0 ? (xy - x * y / n) / std::sqrt(vx * vy) : 0.0;
    }
};

// The blocks of ST-SIM and SPQI.
constexpr std::size_t block = 512;
constexpr double block_rate = 8000.0;
using Block = std::array<double, block>;

/// Levels of the orthonormal cosine transform above the threshold of touch, dB.
class PerceptualSpectrum {
public:
    PerceptualSpectrum() {
        // As published: the grid runs from 0 to the rate inclusive, its lower half is used, and the first value above
        // 0 holds for the rest.
        for (std::size_t k = 0; k < block; ++k)
            threshold_[k] = k > 0 && threshold_[k - 1] > 0.0
                                ? threshold_[k - 1]
                                : touch_curve_db(block_rate * static_cast<double>(k) / (2.0 * block - 1.0));
    }

    Block operator()(std::span<const double> samples) const {
        const auto spectrum = spectrum_of(samples, 2 * block);
        Block levels;
        for (std::size_t k = 0; k < block; ++k) {
            const double turned = (spectrum[k] * std::polar(1.0, -pi * static_cast<double>(k) / (2.0 * block))).real();
            const double value = turned * std::sqrt((k == 0 ? 1.0 : 2.0) / block);
            levels[k] = 20.0 * std::log10(std::max(std::abs(value), 1e-30)) - threshold_[k];
        }
        return levels;
    }

private:
    Block threshold_{};
};

Block support(const Block& levels) {
    Block out;
    for (std::size_t k = 0; k < block; ++k) out[k] = 0.5 * std::erfc(-levels[k] / 12.0 / std::numbers::sqrt2);
    return out;
}

Block standardised(std::span<const double> samples) {
    double mean = 0.0, square = 0.0;
    for (const double x : samples) mean += x / block;
    for (const double x : samples) square += (x - mean) * (x - mean) / block;
    Block out;
    for (std::size_t k = 0; k < block; ++k) out[k] = (samples[k] - mean) / (std::sqrt(square) + 1e-300);
    return out;
}

/// Projection of the output on the reference.
double likeness(const Block& reference, const Block& output) {
    double product = 0.0, power = 0.0;
    for (std::size_t k = 0; k < block; ++k) {
        product += reference[k] * output[k];
        power += reference[k] * reference[k];
    }
    return product / (power + 2.2e-16);
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
            decibel(std::max(pair.reference[k], least) / std::max(gain * gain * pair.output[k], least));
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
    // Half a percent of tolerance: the band called 40 Hz has its true centre at 39.8 Hz.
    const int first = static_cast<int>(std::ceil(10.0 * std::log10(lowest * 0.99)));
    const int last = static_cast<int>(std::floor(10.0 * std::log10(highest * 1.01)));
    std::vector<double> levels;
    double greatest = 0.0;
    for (int n = first; n <= last; ++n) {
        const double centre = std::pow(10.0, n / 10.0);
        levels.push_back(
            band_power(pair.reference, pair.step, centre * std::pow(10.0, -0.05), centre * std::pow(10.0, 0.05)));
        greatest = std::max(greatest, levels.back());
    }
    std::vector<BandError> errors;
    for (int n = first; n <= last; ++n) {
        const double reference = levels[static_cast<std::size_t>(n - first)];
        if (!(reference > floor_ratio * greatest)) continue;
        const double centre = std::pow(10.0, n / 10.0);
        const double output =
            gain * gain *
            band_power(pair.output, pair.step, centre * std::pow(10.0, -0.05), centre * std::pow(10.0, 0.05));
        errors.push_back({centre, decibel(std::max(output / reference, 1e-6))});
    }
    return errors;
}

double st_sim(std::span<const double> reference, std::span<const double> output) {
    const PerceptualSpectrum perceive;
    double spectral = 0.0, temporal = 0.0;
    const std::size_t blocks = std::min(reference.size(), output.size()) / block;
    for (std::size_t b = 0; b < blocks; ++b) {
        const auto r = reference.subspan(b * block, block), d = output.subspan(b * block, block);
        spectral += likeness(support(perceive(r)), support(perceive(d)));
        temporal += likeness(standardised(r), standardised(d));
    }
    if (blocks == 0 || temporal <= 0.0) return 0.0;
    const auto count = static_cast<double>(blocks);
    return std::pow(temporal / count, 2.0 / 3.0) * std::cbrt(spectral / count);
}

double spqi(std::span<const double> reference, std::span<const double> output) {
    const PerceptualSpectrum perceive;
    double sum = 0.0;
    const std::size_t blocks = std::min(reference.size(), output.size()) / block;
    for (std::size_t b = 0; b < blocks; ++b) {
        const Block r = perceive(reference.subspan(b * block, block)), d = perceive(output.subspan(b * block, block));
        double difference = 0.0, power = 0.0;
        for (std::size_t k = 0; k < block; ++k) {
            const double pr = std::pow(10.0, 0.1 * r[k]), pd = std::pow(10.0, 0.1 * d[k]);
            difference += std::abs(pr - pd);
            power += pr;
        }
        const double error = decibel(std::max(difference / (power + 2.2e-16), 1e-30));
        sum += 0.5 * (1.0 - std::tanh(0.3 * error + 2.0));
    }
    return blocks > 0 ? sum / static_cast<double>(blocks) : 0.0;
}

double signal_to_noise_db(std::span<const double> reference, std::span<const double> output) {
    double signal = 0.0, noise = 0.0;
    for (std::size_t i = 0; i < std::min(reference.size(), output.size()); ++i) {
        signal += reference[i] * reference[i];
        noise += (reference[i] - output[i]) * (reference[i] - output[i]);
    }
    return decibel(std::max(signal, 1e-300) / std::max(noise, 1e-300));
}

double spectrogram_similarity(std::span<const double> reference, std::span<const double> output, double rate,
                              double lowest, double highest) {
    const auto quarter = static_cast<std::size_t>(std::max(2.0, std::round(rate * 1024.0 / 48000.0 / 4.0)));
    const std::size_t window = 4 * quarter, size = std::min(reference.size(), output.size());
    std::vector<double> hann(window), part(window);
    for (std::size_t i = 0; i < window; ++i)
        hann[i] = 0.5 - 0.5 * std::cos(2.0 * pi * static_cast<double>(i) / static_cast<double>(window));
    const double step = rate / static_cast<double>(window);
    const auto first = static_cast<std::size_t>(std::ceil(lowest / step));
    const auto end = std::min(window / 2, static_cast<std::size_t>(std::floor(highest / step))) + 1;
    const auto powers = [&](std::span<const double> samples) {
        std::vector<double> all;
        for (std::size_t at = 0; at + window <= size; at += quarter) {
            for (std::size_t i = 0; i < window; ++i) part[i] = hann[i] * samples[at + i];
            const auto spectrum = spectrum_of(part, window);
            for (std::size_t k = first; k < end; ++k) all.push_back(std::norm(spectrum[k]));
        }
        double greatest = 0.0;
        for (const double power : all) greatest = std::max(greatest, power);
        for (double& power : all) power = decibel(std::max(power, std::max(floor_ratio * greatest, 1e-300)));
        return all;
    };
    const std::vector<double> r = powers(reference), d = powers(output);
    Pearson pearson;
    for (std::size_t i = 0; i < r.size(); ++i) pearson.add(r[i], d[i]);
    return pearson.value();
}

}  // namespace tactus

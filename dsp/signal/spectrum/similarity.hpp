// SPDX-License-Identifier: Apache-2.0
// Similarity scores of two vibrations. No single score suffices: a plain log-spectral distance of an idling saw
// compares the noise between its lines, SPQI collapses when one line near 250 Hz differs, ST-SIM needs aligned takes.
#pragma once

#include "dsp/signal/spectrum/perception.hpp"
#include "dsp/signal/spectrum/segment_fft.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Correlation coefficient of the added pairs.
struct Pearson {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;

    void add(double a, double b) { n += 1.0, x += a, y += b, xx += a * a, yy += b * b, xy += a * b; }
    /// 0 when one of the two is constant.
    double value() const;
};

/// Power per bin of two spectra of equal length, bin k at k × `step` Hz.
struct SpectrumPair {
    std::span<const double> reference, output;
    double step = 1.0;  ///< Hz
};

/// Root mean square of the level differences from `lowest` to `highest` Hz, dB, with both levels floored 40 dB below
/// the strongest bin of the reference there; the output is first multiplied by `gain`.
double log_spectral_distance(const SpectrumPair& pair, double lowest, double highest, double gain = 1.0);

/// Cosine similarity of the amplitude spectra from `lowest` to `highest` Hz; 1: same shape. `unit` selects perceptual
/// weights. 0 when one of them is silent.
double spectral_cosine(const SpectrumPair& pair, double lowest, double highest,
                       ThresholdUnit unit = ThresholdUnit::none);

struct BandError {
    double hz = 0.0;        ///< true centre, 10^(n/10)
    double error_db = 0.0;  ///< level of the output less that of the reference
};

/// Errors of the third-octave bands with centres from `lowest` to `highest` Hz (where the reference is within 40 dB of
/// its strongest band); the output is first multiplied by `gain`. The error of a band without output is limited to −60
/// dB.
std::vector<BandError> third_octave_errors(const SpectrumPair& pair, double lowest, double highest, double gain = 1.0);

/// The greatest absolute error. Does not allocate.
double third_octave_max_error(const SpectrumPair& pair, double lowest, double highest, double gain = 1.0) noexcept;

/// Scores of two aligned takes, both at 8 kHz, in pieces and in constant memory.
class WaveformSimilarity {
public:
    WaveformSimilarity();

    /// Equally many samples of each.
    void push(std::span<const double> reference, std::span<const double> output);

    /// Spectral-temporal similarity (ST-SIM): blocks of 512 samples, orthonormal DCT, levels above the tactile
    /// threshold through a normal distribution of 12 dB; temporal^(2/3) × spectral^(1/3). 1 for equal takes, 0 when the
    /// temporal part is negative.
    double st_sim() const;
    /// Spectral perceptual quality index (SPQI) on the same blocks, 0 to 1.
    double spqi() const;
    /// 10 log10 of the power of the reference over that of the difference.
    double signal_to_noise_db() const;

private:
    static constexpr std::size_t block = 512;
    using Block = std::array<double, block>;
    void take_block();
    Block perceived(const Block& samples) const;

    Block threshold_, reference_{}, output_{};
    std::size_t held_ = 0, blocks_ = 0;
    double spectral_ = 0.0, temporal_ = 0.0, quality_ = 0.0, signal_ = 0.0, noise_ = 0.0;
};

/// The same for takes in memory, over the length of the shorter one. Allocates.
double st_sim(std::span<const double> reference, std::span<const double> output);
double spqi(std::span<const double> reference, std::span<const double> output);
double signal_to_noise_db(std::span<const double> reference, std::span<const double> output);

/// Correlation coefficient of two spectrograms in dB, each floored 40 dB below its maximum: Hann windows of 21 ms with
/// a step of a quarter. The takes are pushed twice in pieces, as the first pass finds the maxima.
class SpectrogramSimilarity {
public:
    /// Compares takes at `rate` Hz, from `lowest` to `highest` Hz.
    SpectrogramSimilarity(double rate, double lowest, double highest);

    /// Equally many samples of each.
    void push(std::span<const double> reference, std::span<const double> output);
    /// Call when both takes are complete, after the first and the second pass.
    void end_of_pass();
    double value() const { return pearson_.value(); }

private:
    /// Columns of one take: powers of the bins in the band.
    struct Columns {
        SegmentFft<double> transform;
        std::vector<double> waiting, powers;
        std::size_t held = 0;
        double greatest = 0.0;
    };
    void take(Columns& columns, std::size_t count);
    void compare_columns();

    std::size_t quarter_, first_, end_;
    Columns reference_, output_;
    bool second_ = false;
    Pearson pearson_;
};

/// The same for takes in memory, over their common length. Allocates.
double spectrogram_similarity(std::span<const double> reference, std::span<const double> output, double rate,
                              double lowest, double highest);

}  // namespace tactus::signal

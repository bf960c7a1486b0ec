// SPDX-License-Identifier: Apache-2.0
// How alike two vibrations are. No score tells it alone: a plain log-spectral distance of an idling saw compares the
// noise between its lines, SPQI collapses when one line near 250 Hz differs, ST-SIM needs the two to be aligned.
#pragma once

#include "dsp/spectrum/perception.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus {

/// Power per bin of two spectra of equal length, bin k at k × `step` Hz.
struct SpectrumPair {
    std::span<const double> reference, output;
    double step = 1.0;  ///< Hz
};

/// Root mean square of the level differences from `lowest` to `highest` Hz, dB, both levels cut 40 dB below the
/// strongest bin of the reference there, the output multiplied by `gain` before.
double log_spectral_distance(const SpectrumPair& pair, double lowest, double highest, double gain = 1.0);

/// Cosine between the amplitude spectra from `lowest` to `highest` Hz: 1 for the same shape. `unit` weighs as touch
/// does. 0 when one of them is silent.
double spectral_cosine(const SpectrumPair& pair, double lowest, double highest,
                       ThresholdUnit unit = ThresholdUnit::none);

struct BandError {
    double hz = 0.0;        ///< true centre, 10^(n/10)
    double error_db = 0.0;  ///< level of the output less that of the reference
};

/// Errors of the third-octave bands with centres from `lowest` to `highest` Hz (the reference within 40 dB of its
/// strongest band there), the output multiplied by `gain` before. A band without output errs by −60 dB at most.
std::vector<BandError> third_octave_errors(const SpectrumPair& pair, double lowest, double highest, double gain = 1.0);

/// Spectral-temporal similarity of two aligned takes at 8 kHz: blocks of 512 samples, orthonormal cosine transform,
/// levels above the threshold of touch through a normal distribution of 12 dB; temporal^(2/3) × spectral^(1/3). 1 when
/// they are the same, 0 when the temporal part is negative. The shorter one counts. Allocates.
double st_sim(std::span<const double> reference, std::span<const double> output);

/// Spectral perceptual quality index of two takes at 8 kHz, 0 to 1, on the same blocks. Allocates.
double spqi(std::span<const double> reference, std::span<const double> output);

/// 10 log10 of the power of the reference over that of the difference; aligned takes.
double signal_to_noise_db(std::span<const double> reference, std::span<const double> output);

/// Correlation coefficient of the two spectrograms in dB from `lowest` to `highest` Hz, each cut 40 dB below its
/// strongest point: Hann windows of 21 ms, a quarter apart, over the common length. Allocates.
double spectrogram_similarity(std::span<const double> reference, std::span<const double> output, double rate,
                              double lowest, double highest);

}  // namespace tactus

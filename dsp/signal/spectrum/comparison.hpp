// SPDX-License-Identifier: Apache-2.0
// Compares two vibrations, for example a take of a saw and a take of an actuator that reproduces it.
#pragma once

#include "dsp/signal/spectrum/above_noise.hpp"
#include "dsp/signal/spectrum/alignment.hpp"
#include "dsp/signal/spectrum/course.hpp"
#include "dsp/signal/spectrum/line_match.hpp"
#include "dsp/signal/spectrum/perception.hpp"
#include "dsp/signal/spectrum/similarity.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace tactus::signal {

/// A record that can be read repeatedly from its start, in pieces; it need not fit in memory.
struct Take {
    /// The next samples, any number; none at the end. Valid until the next call.
    using Blocks = std::function<std::span<const double>()>;

    double rate = 48000.0;    ///< Hz
    std::size_t frames = 0;   ///< samples in all
    std::function<Blocks()> open;
    double usable = 0.45 * rate;  ///< Hz: upper limit of the valid frequency range

    Take(double sample_rate, std::size_t count, std::function<Blocks()> opener)
        : rate(sample_rate), frames(count), open(std::move(opener)) {}
    /// Makes a take from samples in memory, which must outlive it.
    Take(std::span<const float> samples, double sample_rate);
    Take(std::span<const double> samples, double sample_rate);
};

struct ComparisonOptions {
    ThresholdUnit touch = ThresholdUnit::displacement;
    /// Largest delay or advance of the output, s; limited to an overlap of at least 1 s and a quarter.
    double longest_delay = std::numeric_limits<double>::infinity();
    /// The other axes of both takes, sampled together with them: spectra are then sums of the powers of all axes.
    std::vector<Take> reference_axes{}, output_axes{};
};

/// The band of scores, Hz: from `min_frequency` to the upper limit of both takes, at most `max_frequency`. A band
/// that ends below `narrowest_band` is too narrow to compare.
inline constexpr double min_frequency = 40.0, max_frequency = 1000.0, touch_end = 500.0, narrowest_band = 80.0;

struct Comparison {
    Alignment alignment;
    double lowest = min_frequency, highest = max_frequency;  ///< Hz: the valid band of both takes
    /// Hz: end of the band of `lsd_db` and `cosine_500`.
    double touched() const { return std::min(touch_end, highest); }
    double gain_db = 0.0;  ///< gain that gives the output the reference's power in the band
    double reference_rms = 0.0, output_rms = 0.0; ///< in the band
    double lsd_db = 0.0;                          ///< to touched()
    double cosine_500 = 0.0, cosine_1000 = 0.0;   ///< to touched(), to highest
    AboveNoise above_noise;
    std::optional<double> harmonic_error_db;      ///< none when the reference has no harmonics
    std::vector<BandError> third_octaves;
    double third_octave_max_db = 0.0, third_octave_rms_db = 0.0;
    double spectrogram_similarity = 0.0;
    std::optional<double> st_sim, spqi, signal_to_noise_db;  ///< for aligned takes only, trusted up to 1 kHz
    std::optional<double> coherence_mean;                    ///< for aligned takes only
    double touch_cosine = 0.0;  ///< cosine_1000 with perceptual weights
    double touch_gap_db = 0.0;  ///< by how much the output is perceived as stronger at equal power
    /// Of aligned takes, dB: rms difference of their levels over time; see `course_difference_db`.
    std::optional<double> course_db;
    /// Of separate takes of at least 1 s: their statistics over time.
    std::optional<StatisticsDifference> statistics;
    double reference_kurtosis = 0.0, output_kurtosis = 0.0;  ///< in the band
    double reference_inside = 0.0, output_inside = 0.0;  ///< fraction of the variance of each take within the band
    double reference_hz = 0.0, output_hz = 0.0;  ///< fundamentals; 0 when none was found
    /// Hz: rates at orders of the mains that may be hum or a machine's; 0: none. They are no fundamentals.
    double reference_hum_hz = 0.0, output_hum_hz = 0.0;
    double speed_ratio = 1.0;  ///< output's over the reference's, corrected in the spectra
    MatchedLines lines;

    // For plots: power densities of both on one axis, the output with gain and speed corrected.
    std::vector<double> reference_density, output_density, coherence;
    double step = 0.0, coherence_step = 0.0;      ///< Hz
    double end = 0.0;  ///< Hz: half the sample rate of the slower take, at most 4 kHz; densities mean nothing above it
};

/// Compares two takes of any rates and lengths of at least 0.5 s, in constant memory; each is read up to four times.
/// Whether they are simultaneous is determined from their loudest minute. Other takes are compared by their spectra
/// only; if both are of one saw at rates within 3 % of each other, they are compared at equal orders. A rate that may
/// be hum is the saw's if the other take has the same orders at a certain rate that near and not at the mains: hum does
/// not follow the speed of a saw. Throws Error if a take is too short or silent, or is not valid up to
/// `narrowest_band`. Allocates.
Comparison compare(const Take& reference, const Take& output, const ComparisonOptions& options = {});

}  // namespace tactus::signal

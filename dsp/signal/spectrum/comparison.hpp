// SPDX-License-Identifier: Apache-2.0
// Whether one vibration is the same as another: a take of a saw, and a take of what an actuator made of it.
#pragma once

#include "dsp/signal/spectrum/alignment.hpp"
#include "dsp/signal/spectrum/line_match.hpp"
#include "dsp/signal/spectrum/perception.hpp"
#include "dsp/signal/spectrum/similarity.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace tactus::signal {

/// A record that can be read from its start as often as needed, in pieces: it need not fit in memory.
struct Take {
    /// The next samples, of any number; none at the end. Good until the next call.
    using Blocks = std::function<std::span<const double>()>;

    double rate = 48000.0;    ///< Hz
    std::size_t frames = 0;   ///< samples in all
    std::function<Blocks()> open;

    Take(double sample_rate, std::size_t count, std::function<Blocks()> opener)
        : rate(sample_rate), frames(count), open(std::move(opener)) {}
    /// Of samples in memory, which must stay there.
    Take(std::span<const float> samples, double sample_rate);
    Take(std::span<const double> samples, double sample_rate);
};

struct ComparisonOptions {
    ThresholdUnit touch = ThresholdUnit::displacement;
    double longest_delay = 2.0;  ///< s, of the output behind the reference or before it
};

struct Comparison {
    Alignment alignment;
    double lowest = 40.0, highest = 1000.0;       ///< Hz: the band that both takes can carry
    double gain_db = 0.0;                         ///< that gives the output the reference's power in the band
    double reference_rms = 0.0, output_rms = 0.0; ///< in the band
    double lsd_db = 0.0;                          ///< 40 to 500 Hz
    double cosine_500 = 0.0, cosine_1000 = 0.0;
    std::optional<double> harmonic_error_db;      ///< none when the reference has no harmonics
    std::vector<BandError> third_octaves;
    double third_octave_max_db = 0.0, third_octave_rms_db = 0.0;
    double spectrogram_similarity = 0.0;
    std::optional<double> st_sim, spqi, coherence_mean, signal_to_noise_db;  ///< of aligned takes only
    double touch_cosine = 0.0;                    ///< cosine_1000 weighted as touch does
    double touch_gap_db = 0.0;                    ///< how much stronger the output feels once its power is the same
    double reference_hz = 0.0, output_hz = 0.0;   ///< fundamentals; 0 when none was found
    double speed_ratio = 1.0;                     ///< output's over the reference's, taken out of the spectra
    MatchedLines lines;

    // For a picture: power densities of both over one axis, the output with its gain and speed corrected.
    std::vector<double> reference_density, output_density, coherence;
    double step = 0.0, coherence_step = 0.0;      ///< Hz
};

/// Compares two takes of any rates and lengths, 0.5 s or longer, in memory that does not grow with them; each is read up to
/// four times. Whether they belong together is judged from their loudest minute. Takes that do not belong together are compared by
/// their spectra only; when both are one saw at rates within 3 % of each other, they are compared at equal orders.
/// Throws Error when a take is too short, too slow or silent. Allocates.
Comparison compare(const Take& reference, const Take& output, const ComparisonOptions& options = {});

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
// Whether two vibrations are alike, told while they go on.
#pragma once

#include "dsp/signal/spectrum/live_spectrum.hpp"

namespace tactus::signal {

/// The scores of `compare` that need spectra only.
struct LiveScores {
    bool heard = false;                ///< both came loud and long enough to be judged; else the rest is 0
    double lsd_db = 0.0;               ///< log-spectral distance, 40 to 500 Hz
    double cosine_500 = 0.0;           ///< of the amplitude spectra, 40 to 500 Hz
    double third_octave_max_db = 0.0;  ///< worst band, 40 to 1000 Hz
    double gain_db = 0.0;              ///< that gives the output the reference's power, 40 to 1000 Hz
};

/// Follows a reference and an output, each at its own rate; a constant delay between them does not matter. Segments are
/// those of `compare`: 128 ms for distance and cosine, 512 ms for bands.
class LiveComparison {
public:
    LiveComparison() : LiveComparison(48000.0, 48000.0, 1.0) {}
    /// Rates in Hz (223 or more, or nothing is heard up to the band's end), `memory` in s. Allocates.
    LiveComparison(double reference_rate, double output_rate, double memory);

    /// Wait-free, allocate nothing.
    /// Returns how many segments became whole: without one the scores stay.
    int push_reference(std::span<const float> samples) noexcept;
    int push_output(std::span<const float> samples) noexcept;
    LiveScores scores() const noexcept;

private:
    /// Two resolutions of one vibration.
    struct Heard {
        LiveSpectrum coarse, fine;
        Heard(double rate, double memory);
    };
    Heard reference_, output_;
    double highest_ = 1000.0;  // Hz that both carry
};

}  // namespace tactus::signal

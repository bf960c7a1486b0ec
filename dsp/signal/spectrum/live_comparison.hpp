// SPDX-License-Identifier: Apache-2.0
// Compares two vibrations while they run.
#pragma once

#include "dsp/signal/spectrum/live_spectrum.hpp"

namespace tactus::signal {

/// The spectral scores of `compare`.
struct LiveScores {
    bool heard = false;  ///< both were loud and long enough; otherwise the other members are 0
    double lsd_db = 0.0;               ///< log-spectral distance, 40 to 500 Hz
    double cosine_500 = 0.0;           ///< of the amplitude spectra, 40 to 500 Hz
    double third_octave_max_db = 0.0;  ///< worst band, 40 to 1000 Hz
    double gain_db = 0.0;  ///< gain that gives the output the reference's power, 40 to 1000 Hz
};

/// Follows a reference and an output, each at its own rate; a constant delay between them has no effect. Segments are
/// those of `compare`: 128 ms for distance and cosine, 512 ms for bands.
class LiveComparison {
public:
    LiveComparison() : LiveComparison(48000.0, 48000.0, 1.0) {}
    /// Rates in Hz (at least 223, or the comparison stays without result), `memory` in s. Allocates.
    LiveComparison(double reference_rate, double output_rate, double memory);

    /// Wait-free, does not allocate.
    /// Returns the number of completed segments: without one the scores stay the same.
    int push_reference(std::span<const float> samples) noexcept;
    int push_output(std::span<const float> samples) noexcept;
    LiveScores scores() const noexcept;

private:
    /// Spectra of one vibration at two resolutions.
    struct Heard {
        LiveSpectrum coarse, fine;
        Heard(double rate, double memory);
    };
    Heard reference_, output_;
    double highest_ = 1000.0;  // Hz, upper limit of both
};

}  // namespace tactus::signal

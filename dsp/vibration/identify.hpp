// SPDX-License-Identifier: Apache-2.0
// A system's response, coherence, latency and distortion from what comes back of an exponential sweep.
#pragma once

#include "dsp/vibration/frequency_response.hpp"
#include "dsp/vibration/sweep.hpp"

#include <span>
#include <vector>

namespace tactus::vibration {

/// How the sweep was played.
struct SweepRun {
    ExponentialSweep sweep;
    double amplitude = 1.0;  ///< of the drive
    double pause = 1.0;      ///< silence after each sweep, s; longer than latency and ringing together
    int repeats = 1;
};

/// Distortion of one order, at the exciting frequencies of the response.
struct Distortion {
    int order = 2;
    /// Amplitude at order × hz over that at hz, when a sine of hz excites; NaN where the sweep does not reach.
    std::vector<double> ratio;
};

struct Identified {
    FrequencyResponse response;
    std::vector<Distortion> distortions;  ///< orders 2, 3, ...
};

/// Identifies what made `captured` (samples at `rate` Hz, from the instant the first sweep began) of the sweep. The
/// cross-spectrum is averaged over all repeats and over a few Hz around each of the `per_octave` frequencies: what does
/// not repeat, and what lies at other times than the linear response, as distortion does, averages out and lowers the
/// coherence. Throws Error when the record is too short or holds nothing of the sweep. Allocates.
Identified identify(const SweepRun& run, std::span<const float> captured, double rate, int highest_order = 5,
                    int per_octave = 48);

}  // namespace tactus::vibration

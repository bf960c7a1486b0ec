// SPDX-License-Identifier: Apache-2.0
// System identification with an exponential sweep: response, coherence, latency and distortion.
#pragma once

#include "dsp/vibration/frequency_response.hpp"
#include "dsp/vibration/sweep.hpp"

#include <span>
#include <vector>

namespace tactus::vibration {

/// Parameters of the played sweep.
struct SweepRun {
    ExponentialSweep sweep;
    double amplitude = 1.0;  ///< of the drive
    double pause = 1.0;      ///< silence after each sweep, s; longer than latency and ringing together
    int repeats = 1;
};

/// Distortion of one order, at the excitation frequencies of the response.
struct Distortion {
    int order = 2;
    /// Amplitude at order × hz over that at hz, for a sine of hz; NaN where the sweep does not reach.
    std::vector<double> ratio;
};

/// A resonance found by a local model with one pole, whatever its width.
struct Mode {
    double hz = 0.0, damping = 0.0;     ///< f0 and ζ
    double deviation = 0.0;             ///< standard deviation of ζ, relative to it
    double truncation = 0.0;  ///< bound of the bias of ζ, relative: amplitude left at the end of the record
    double peak = 0.0;  ///< greatest gain of the response there
    double needed_duration = 0.0;  ///< s, of a sweep that halves 5 % of both; at most the present one when it suffices

    bool is_resolved() const { return 2.0 * deviation <= 0.05 && truncation <= 0.05; }
};

struct Identified {
    FrequencyResponse response;
    std::vector<Distortion> distortions;  ///< orders 2, 3, ...
    std::vector<Mode> modes;  ///< by frequency
};

/// Identifies the system that produced `captured` (samples at `rate` Hz, from the start of the first sweep) from the
/// sweep. Averages the cross-spectrum over all repeats and over a few Hz around each of the `per_octave` frequencies:
/// components that do not repeat, or that occur at other times than the linear response (distortion), cancel and lower
/// the coherence. Where one pole explains the bins better than their average, the local model takes its place, and the
/// response has further frequencies around each resonance that is narrower than the averages: its resolution is that of
/// the record. Throws Error when the record is too short or does not contain the sweep. Allocates.
Identified identify(const SweepRun& run, std::span<const float> captured, double rate, int highest_order = 5,
                    int per_octave = 48);

}  // namespace tactus::vibration

// SPDX-License-Identifier: Apache-2.0
// Inverse filter of an actuator's response, within its band and with bounded gain.
#pragma once

#include "dsp/vibration/frequency_response.hpp"

#include <string>
#include <vector>

namespace tactus::vibration {

enum class EqualiserKind {
    minimum_phase,  ///< adds at most 2 ms: for signals driven by a hand
    linear_phase,  ///< also corrects the phase and adds half its length: for signals known beforehand
};

struct EqualiserDesign {
    EqualiserKind kind = EqualiserKind::minimum_phase;
    double rate = 48000.0;  ///< of the signal to be filtered, Hz
    double lowest = 45.0;  ///< Hz: the band to equalise ...
    double highest = 1000.0;  ///< ... beyond which the filter fades out within an octave or less
    double length = 0.128;         ///< of the impulse response, s
    double greatest_gain = 10.0;   ///< of the filter: 20 dB
    double regularisation = 1e-4;  ///< β in the band, relative to the squared mean gain of the actuator
};

struct Equaliser {
    EqualiserKind kind = EqualiserKind::minimum_phase;
    double rate = 48000.0;     ///< Hz
    double delay = 0.0;  ///< latency of the filter, s
    double lowest = 0.0, highest = 0.0;  ///< the band, Hz
    double mean_gain = 1.0;  ///< of the actuator in the band: the gain of actuator and equaliser together
    std::string unit;  ///< of `mean_gain`, "m/s^2 per V"; for display
    std::vector<float> taps;   ///< impulse response

    /// Complex gain of the filter at a frequency in Hz.
    std::complex<double> gain(double frequency) const;
};

/// The regularised inverse C = g D H* / (|H|² + β g²) (Kirkeby and Nelson 1999), with g the geometric mean of |H| over
/// the band, D a delay, and β rising to 1 outside the band. The response must cover the band. Throws Error. Allocates.
Equaliser design_equaliser(const FrequencyResponse& response, const EqualiserDesign& design = {});

}  // namespace tactus::vibration

// SPDX-License-Identifier: Apache-2.0
// How strongly and with which phase a system answers each frequency.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tactus::vibration {

struct FrequencyResponse {
    std::vector<double> hz;                  ///< rising, above 0
    std::vector<std::complex<double>> gain;  ///< output per unit of input, with the latency taken out
    std::vector<double> coherence;           ///< 0 to 1 at each frequency; empty when unknown
    double latency = 0.0;                    ///< pure delay, s; not in `gain`

    bool empty() const { return hz.empty(); }
};

/// Angles in rad, each within half a turn of its neighbour: neighbouring frequencies must lie close enough for that.
std::vector<double> unwrapped_phase(std::span<const std::complex<double>> gain);

/// The response at other frequencies (rising): level in dB and phase are linear over log frequency between two
/// measured ones; outside of them the nearest holds. Allocates.
std::vector<std::complex<double>> interpolate(const FrequencyResponse& response, std::span<const double> hz);

/// Phase in rad that a minimum-phase system with those magnitudes has (Bode 1945), the level's slope continued beyond
/// both ends. At least 3 frequencies, every magnitude above 0. Allocates.
std::vector<double> minimum_phase(std::span<const double> hz, std::span<const double> magnitude);

/// A mass on a spring in a response: |H| ∝ f^order / |f0² − f² + 2jζ f0 f|.
struct Resonance {
    double hz = 0.0;        ///< f0 of the undamped system; 0 when there is none
    double damping = 0.0;   ///< ζ, ratio to critical
    int order = 2;          ///< 0 displacement, 1 velocity, 2 acceleration per force
    double error_db = 0.0;  ///< rms of what the fit leaves, from `lowest` to `highest`
};

/// The resonance that explains the level between `lowest` and `highest` (Hz) best. Further modes disturb it little: a
/// deviation counts by its logarithm once it exceeds 1 dB. A level that a straight line over log frequency explains as
/// well, or within 0.5 dB, has no resonance there. Throws Error with fewer than 8 frequencies there. Allocates.
Resonance fit_resonance(const FrequencyResponse& response, double lowest, double highest);

}  // namespace tactus::vibration

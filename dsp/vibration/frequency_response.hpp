// SPDX-License-Identifier: Apache-2.0
// Measured frequency responses: interpolation, minimum phase, resonance.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tactus::vibration {

struct FrequencyResponse {
    std::vector<double> hz;                  ///< rising, above 0
    std::vector<std::complex<double>> gain;  ///< output per unit of input, without the latency
    std::vector<double> coherence;           ///< 0 to 1 at each frequency; empty when unknown
    double latency = 0.0;                    ///< pure delay, s; not in `gain`

    bool empty() const { return hz.empty(); }
};

/// Unwrapped angles in rad: neighbouring frequencies must be so close that their angles differ by less than π.
std::vector<double> unwrapped_phase(std::span<const std::complex<double>> gain);

/// The response at other frequencies (ascending): level in dB and phase are linear over log frequency between two
/// measured ones; outside of them the nearest is used. Allocates.
std::vector<std::complex<double>> interpolate(const FrequencyResponse& response, std::span<const double> hz);

/// Phase in rad of a minimum-phase system with those magnitudes (Bode 1945), with the level extrapolated linearly
/// beyond both ends. At least 3 frequencies, every magnitude above 0. Allocates.
std::vector<double> minimum_phase(std::span<const double> hz, std::span<const double> magnitude);

/// A mass-spring resonance in a response: |H| ∝ f^order / |f0² − f² + 2jζ f0 f|.
struct Resonance {
    double hz = 0.0;        ///< f0 of the undamped system; 0 when there is none
    double damping = 0.0;  ///< damping ratio ζ
    int order = 2;          ///< 0 displacement, 1 velocity, 2 acceleration per force
    double error_db = 0.0;  ///< rms residual from `lowest` to `highest`
};

/// The resonance that fits the level between `lowest` and `highest` (Hz) best. Robust against further modes: deviations
/// beyond 1 dB count by their logarithm. There is no resonance when a straight line over log frequency fits as well, or
/// within 0.5 dB. Throws Error with fewer than 8 frequencies there. Allocates.
Resonance fit_resonance(const FrequencyResponse& response, double lowest, double highest);

}  // namespace tactus::vibration

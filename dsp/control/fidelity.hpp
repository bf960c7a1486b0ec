// SPDX-License-Identifier: Apache-2.0
// How faithfully a device renders an object: the response to a swinging force beside that of the object itself
// (admittance fidelity, thesis 6.3.4).
#pragma once

#include "dsp/control/virtual_object.hpp"

#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::control {

/// What was measured while the rig swung at one rate: equally spaced, SI.
struct RigSeries {
    double period = 1.0 / 150.0;        ///< s between samples
    std::vector<double> force;          ///< N on the finger
    std::vector<double> position;       ///< m of the finger
    std::vector<std::uint8_t> slips;    ///< 1 where the motor slipped; empty: not known, none
    std::vector<std::uint8_t> saturated;  ///< 1 where the motor was asked for more than it can; empty: not known
};

struct Fidelity {
    std::complex<double> force, position;       ///< phasors at the rate: N, m
    std::optional<double> gain_error_db;        ///< 20 log10 |Y/Y0|; none for a wall, whose Y0 is 0
    std::optional<double> phase_error_deg;
    std::optional<double> nrmse;                ///< of the samples without slip; none for a wall, or when all slip
    double rendered_stiffness = 0.0;            ///< N/m: Re 1/Y
    double rendered_damping = 0.0;              ///< N·s/m: Im(1/Y)/ω
    double penetration = 0.0;                   ///< m, farthest that a wall was pushed away
    double position_rms_error = 0.0;            ///< m, over the samples without slip
    double limit_cycle_rms = 0.0;               ///< m that is no harmonic of the rate: hunting
    double slip_share = 0.0, saturated_share = 0.0;  ///< of all samples
    double speed_peak = 0.0;                    ///< m/s of the finger's fundamental
    double cycles = 0.0;                        ///< that were looked at
};

/// 1 / (k + jωb − ω²m) in m/N; 0 for a wall.
std::complex<double> ideal_admittance(const ObjectSettings& object, double rate) noexcept;

/// What the object would have done under the very force that was measured, from where the finger was first. Linear
/// between samples of a massless two-sided object; held at the mean of two samples for others.
std::vector<double> ideal_response(const RigSeries& series, const ObjectSettings& object);

/// Looks at the last whole cycles after `settle` s. Throws Error when fewer than two are left, and on numbers that are not finite.
Fidelity judge_fidelity(const RigSeries& series, const ObjectSettings& object, double rate, double settle);

}  // namespace tactus::control

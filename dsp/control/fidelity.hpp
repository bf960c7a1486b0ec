// SPDX-License-Identifier: Apache-2.0
// Admittance fidelity (thesis 6.3.4): compares a device's response to an oscillating force with that of the object that
// it renders.
#pragma once

#include "dsp/control/virtual_object.hpp"

#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::control {

/// A measurement at one rate of the rig: equally spaced samples, SI units.
struct RigSeries {
    double period = 1.0 / 150.0;  ///< s between samples
    std::vector<double> force;  ///< N on the finger
    std::vector<double> position;  ///< m of the finger
    std::vector<std::uint8_t> slips;  ///< 1 where the motor slipped; empty: unknown, taken as none
    std::vector<std::uint8_t> saturated;  ///< 1 where the command exceeded the motor's limits; empty: unknown
};

struct Fidelity {
    std::complex<double> force, position;  ///< phasors at the rate: N, m
    std::optional<double> gain_error_db;  ///< 20 log10 |Y/Y0|; none for a wall, whose Y0 is 0
    std::optional<double> phase_error_deg;
    std::optional<double> nrmse;  ///< of the samples without slip; none for a wall, or when all slip
    double rendered_stiffness = 0.0;  ///< N/m: Re 1/Y
    double rendered_damping = 0.0;  ///< N·s/m: Im(1/Y)/ω
    double penetration = 0.0;  ///< m, greatest distance by which a wall was displaced
    double position_rms_error = 0.0;  ///< m, over the samples without slip
    double limit_cycle_rms = 0.0;  ///< m of residual that is not harmonic: limit cycles
    double slip_share = 0.0, saturated_share = 0.0;  ///< of all samples
    double speed_peak = 0.0;  ///< m/s of the finger's fundamental
    double cycles = 0.0;  ///< number of cycles evaluated
};

/// 1 / (k + jωb − ω²m) in m/N; 0 for a wall.
std::complex<double> ideal_admittance(const ObjectSettings& object, double rate) noexcept;

/// Response of the object to the measured force, from the finger's first position. The force is linear between samples
/// for a massless two-sided object; for others it is held at the mean of two samples.
std::vector<double> ideal_response(const RigSeries& series, const ObjectSettings& object);

/// Evaluates the last whole cycles after `settle` s. Throws Error when fewer than two are left, and for non-finite
/// numbers.
Fidelity judge_fidelity(const RigSeries& series, const ObjectSettings& object, double rate, double settle);

}  // namespace tactus::control

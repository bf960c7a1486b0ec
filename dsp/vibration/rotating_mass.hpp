// SPDX-License-Identifier: Apache-2.0
// Model of an eccentric rotating mass (ERM) on a handle: input is the drive voltage; outputs are the limited voltage, the
// current and the acceleration of the handle along one axis. Rate and strength of its vibration are coupled: m r ω²/M.
#pragma once

#include "dsp/vibration/actuator.hpp"

namespace tactus::vibration {

/// A motor whose speed follows the voltage with one time constant (Precision Microdrives, bulletin AB-004). SI units.
struct RotatingMassModel {
    double rated_voltage, rated_speed;  ///< V, rad/s at it
    double start_voltage;  ///< V, below which it does not start to turn
    double rise_time;  ///< s, time constant of the speed
    double unbalance;  ///< mass times radius, kg·m
    double resistance;  ///< of the windings, Ω
    double voltage_limit;  ///< V, either sign
};

/// A coin of 8 × 3 mm: 3 V, 67 mA and 9,000 revolutions per minute, from data sheets of its class. Assumed: an
/// unbalance that accelerates 100 g with 0.75 g, 2 V to start, a time constant of 50 ms, and 30 Ω.
inline constexpr RotatingMassModel coin_erm{3.0, 942.4777960769379, 2.0, 0.05, 8.28e-7, 30.0, 3.6};

/// Runs a model sample by sample.
class RotatingMass {
public:
    RotatingMass() = default;
    /// `mass`: total vibrating mass, kg; `rate` in Hz. Throws Error when a value is not above 0, or when the rated speed
    /// does not fit under half of the rate.
    RotatingMass(const RotatingMassModel& model, double mass, double rate);

    /// A drive that is not finite counts as 0 V.
    ActuatorOutput operator()(double drive) noexcept;
    /// Turns per second.
    double frequency() const noexcept;

private:
    RotatingMassModel model_ = coin_erm;
    double step_ = 0.0, decay_ = 0.0, acceleration_ = 0.0, speed_ = 0.0, angle_ = 0.0;
};

}  // namespace tactus::vibration

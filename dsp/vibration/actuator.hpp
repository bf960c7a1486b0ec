// SPDX-License-Identifier: Apache-2.0
// Model of a voice-coil vibration actuator (Haptuator) on a handle: input is the drive voltage; outputs are the limited
// voltage, the coil current and the acceleration of the handle.
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <span>
#include <string_view>

namespace tactus::vibration {

/// Data of an actuator. The moving mass on its spring gives the housing
///   a/v = k s² / (s² + 2 ζ ω0 s + ω0²),
/// with k from the data sheet's acceleration at its frequency, voltage and total mass.
struct ActuatorModel {
    std::string_view name;
    double resonance;  ///< f0, Hz
    double damping;  ///< damping ratio ζ
    double resistance;  ///< of the coil, Ω
    double inductance;  ///< of the coil, H
    double voltage_limit;  ///< V, either sign
    double current_limit;  ///< A, either sign
    double reference_acceleration;  ///< peak m/s² per V ...
    double reference_frequency;  ///< ... at this frequency (Hz) ...
    double reference_mass;  ///< ... with this total mass, kg
};

/// haptuator_small, haptuator_large: f0 and ζ fitted to tones of 50–250 Hz at low and high drive; 24.5 m/s² at 1 V,
/// 150 Hz on 20 g, 6 Ω, 3 V, 0.5 A from the TL002-14R data sheet. markII_D: 65 Hz on 100 g, 4.5 Ω, 128 µH and 8 g
/// peak-to-peak from its data sheet, measured at resonance and the current limit; ζ from the rise time of 14 ms. The
/// coil inductance of the first two is not published; that of markII_D is used.
std::span<const ActuatorModel> actuator_models();

/// The model with that name. Throws Error with the known names.
const ActuatorModel& find_actuator(std::string_view name);

struct ActuatorOutput {
    double voltage = 0.0;  ///< output of the amplifier, V
    double current = 0.0;  ///< in the coil, A
    double acceleration = 0.0;  ///< of the handle, m/s²
    bool limited = false;  ///< the drive exceeded the limits
};

/// Runs a model sample by sample. The limit is a hard clip, as at an amplifier's rail: at the smaller of the voltage
/// limit and resistance × current limit, which also bounds the current, since the coil's lag cannot overshoot. The coil
/// 1/(1 + s L/R) is discretised step-invariantly, the resonance bilinearly and exact at f0.
class Actuator {
public:
    Actuator() = default;
    /// `rate` in Hz, `mass`: total vibrating mass (housing, handle), kg. Above resonance acceleration goes as 1/mass.
    /// Throws Error when a value is not positive or the resonance does not fit under half the rate.
    Actuator(const ActuatorModel& model, double mass, double rate);

    /// A drive that is not finite counts as 0 V.
    ActuatorOutput operator()(double drive) noexcept;

    /// Acceleration per volt at `frequency`, m/s² per V, without the limits.
    double gain(double frequency) const;
    double greatest_voltage() const { return voltage_limit_; }

private:
    signal::Biquad resonator_;
    double rate_ = 48000.0, resistance_ = 1.0, voltage_limit_ = 0.0;
    double coil_share_ = 1.0, coil_ = 0.0;  // coil_ is R times the current
};

}  // namespace tactus::vibration

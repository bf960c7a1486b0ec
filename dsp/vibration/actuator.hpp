// SPDX-License-Identifier: Apache-2.0
// Model of a vibration actuator with a moving mass on a spring in a coil (Haptuator, voice coil, linear resonant actuator)
// on a handle: input is the drive voltage; outputs are the limited voltage, the coil current and the acceleration of the
// handle.
#pragma once

#include <array>
#include <complex>
#include <span>
#include <string_view>

namespace tactus::vibration {

/// Data of an actuator: a mass m that moves on a spring and in a coil, inside of a housing that vibrates with the
/// handle, of total mass M. Resonance and damping apply at a constant voltage, so that the damping includes the coil's
/// back-EMF. On another handle the resonance is proportional to 1/√(m (M − m)/M).
struct ActuatorModel {
    std::string_view name;
    double resonance;  ///< f0, Hz, at `resonance_mass`
    double damping;  ///< damping ratio ζ there
    double resonance_mass;  ///< total mass M at which f0 and ζ hold, kg
    double moving_mass;  ///< m, kg
    double resistance;  ///< of the coil, Ω
    double inductance;  ///< of the coil, H
    double voltage_limit;  ///< of the amplifier, V, either sign
    double current_limit;  ///< of the coil, A, either sign
    double reference_acceleration;  ///< peak m/s² of the housing per V, or per A ...
    bool per_ampere;  ///< ... of the coil's current ...
    double reference_frequency;  ///< ... at this frequency (Hz) ...
    double reference_mass;  ///< ... with this total mass, kg
    double force_factor = 0.0;  ///< of the coil, N/A; above 0 it replaces the reference
};

/// haptuator_small, haptuator_large: f0 and ζ fitted to tones of 50–250 Hz at low and high drive; 24.5 m/s² at 1 V,
/// 150 Hz on 20 g, 6 Ω, 3 V, 0.5 A from the TL002-14R data sheet. markII_D: 65 Hz on 100 g, 4.4 g moving, 4.5 Ω, 128 µH
/// and 8 g peak-to-peak from its data sheet, measured at resonance and the current limit; ζ from the rise time of 14 ms.
/// Not published for the first two, and assumed: the moving mass and the inductance of markII_D, and 20 g as the mass
/// of f0 and ζ.
/// lra_10mm, a coin of the type VG1040003D (Vybronics, Jinlong): 170 Hz, 2.5 V rms, at most 170 mA rms, 2 g rms, half of the
/// amplitude after 10 ms from its data sheet, from which ζ 0.065 follows. Assumed: 100 g as the mass of the test, the
/// moving mass of 1.3 g, 12 Ω and 0.1 mH.
/// voice_coil_14mm, an exciter of the type TEAX14C02-8 (Tectonic): 2.4 N/A, 7.8 Ω and 0.8 W, hence 3.5 V peak, from its
/// data sheet. Assumed: 5 g of moving mass, 120 Hz and ζ 0.3 on 100 g, and 0.05 mH.
std::span<const ActuatorModel> actuator_models();

/// The model with that name. Throws Error with the known names.
const ActuatorModel& find_actuator(std::string_view name);

/// Mechanical values derived from the data.
struct ActuatorMechanics {
    double force_factor = 0.0;  ///< of the coil, N/A; also its back-EMF, V·s/m
    double stiffness = 0.0;  ///< of the spring, N/m
    double damping = 0.0;  ///< mechanical, N·s/m; the back-EMF adds force_factor² / resistance
};

/// Throws Error when a value is not positive, or when the back-EMF alone would damp more than stated.
ActuatorMechanics mechanics_of(const ActuatorModel& model);

/// The same actuator with another spring, so that it resonates at `frequency` (Hz) on a handle of this total mass (kg);
/// a damping ratio above 0 also gives it other mechanical damping. Throws Error when the back-EMF alone damps more.
ActuatorMechanics tuned(const ActuatorModel& model, ActuatorMechanics mechanics, double mass, double frequency,
                        double damping_ratio);

/// f0 at a constant voltage, Hz, and ζ on a handle of this total mass (kg).
struct ActuatorResonance {
    double frequency = 0.0, damping = 0.0;
};
ActuatorResonance resonance_on(const ActuatorModel& model, double mass);

struct ActuatorOutput {
    double voltage = 0.0;  ///< output of the amplifier, V
    double current = 0.0;  ///< in the coil, A
    double acceleration = 0.0;  ///< of the handle, m/s²
    bool limited = false;  ///< the drive exceeded the limits
};

/// Runs a model sample by sample: coil, back-EMF and both masses, discretised exactly for a voltage that is constant
/// over a sample. The amplifier clips the voltage at its limit, and lowers it where the current would exceed its own.
class Actuator {
public:
    Actuator() = default;
    /// `rate` in Hz, `mass`: total vibrating mass (housing, handle, moving mass), kg. Far above resonance the
    /// acceleration is proportional to 1/(M − m). Throws Error as `mechanics_of` does, for a mass that is not above the
    /// moving one, and when the resonance does not fit under half the rate.
    Actuator(const ActuatorModel& model, double mass, double rate);
    /// Uses the given mechanics instead of those derived from the model.
    Actuator(const ActuatorModel& model, const ActuatorMechanics& mechanics, double mass, double rate);

    /// A drive that is not finite counts as 0 V.
    ActuatorOutput operator()(double drive) noexcept;

    /// Acceleration per volt at `frequency`, m/s² per V, without the limits.
    double gain(double frequency) const;
    /// The largest peak of a steady tone that no limit clips at any frequency, V.
    double greatest_voltage() const { return safe_voltage_; }

private:
    static constexpr std::size_t states = 3;  // current; displacement and speed of the moving mass in the housing
    using State = std::array<double, states>;

    std::array<State, states> step_{};  // state after a sample from the state before
    State input_{};  // and from the voltage
    State output_{};  // acceleration from the state
    State state_{};
    double rate_ = 48000.0, voltage_limit_ = 0.0, current_limit_ = 0.0, safe_voltage_ = 0.0;
};

}  // namespace tactus::vibration

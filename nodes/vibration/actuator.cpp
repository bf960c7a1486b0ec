// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "dsp/signal/filter/fir.hpp"
#include "dsp/signal/filter/loudest_rms.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "dsp/signal/spectrum/perception.hpp"
#include "dsp/vibration/measured_plant.hpp"
#include "dsp/vibration/rotating_mass.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

namespace tactus::nodes {

struct Actuator {
    static constexpr auto about =
        "Model of an actuator on a handle: the voltage of its amplifier and the acceleration of the handle.";

    In<Signal> drive{"signal to play"};
    Out<Signal> voltage{"output of the amplifier", "V"};
    Out<Signal> signal{"acceleration of the handle", "m/s^2"};
    Out<Signal> current{"in the coil", "A"};
    Text actuator{"", "name of an entry of [actuators], which has the settings that are not given here"};
    Choice preset{{"haptuator_small", "haptuator_large", "markII_D", "lra_10mm", "voice_coil_14mm", "erm_coin"},
                  "data of the actuator; used for parameters that are 0"};
    Asset<sound::ResponseFile> response{
        optional,
        "measured response, m/s^2 per V, in place of the model: a CSV file of 'tactus measure' or 'tactus response'"};
    Param gain{"1 V", "-100 V", "100 V", "drive voltage per unit of the signal"};
    Param mass{structural, "100 g", "1 g", "10 kg", "total vibrating mass: handle, housing and moving mass"};
    Param moving_mass{structural, "0 g", "0 g", "10 kg", "in the housing; the resonance depends on both masses"};
    Param resonance{structural, "0 Hz", "0 Hz", "2 kHz", "on this handle at a constant voltage, back-EMF included"};
    Param damping{structural, "0", "0", "10", "damping ratio on this handle, back-EMF included"};
    Param q{structural, "0", "0", "1000", "quality factor on this handle, instead of the damping ratio: 1/(2 damping)"};
    Param force_factor{structural, "0 N/A", "0 N/A", "1000 N/A", "of the coil; it also sets the back-EMF"};
    Param resistance{structural, "0 ohm", "0 ohm", "1 kohm", "of the coil"};
    Param inductance{structural, "0 mH", "0 mH", "1 H", "of the coil"};
    Param voltage_limit{structural, "0 V", "0 V", "100 V", "of the amplifier"};
    Param current_limit{structural, "0 A", "0 A", "100 A", "of the coil"};
    Param force_limit{structural, "0 N", "0 N", "10 kN", "of the coil, by its current"};

    void prepare(const Setup& setup) {
        try {
            if (response) measured(setup);
            else if (preset.is("erm_coin")) rotating(setup);
            else moving(setup);
        } catch (const Error& error) {
            setup.fail(error.message());
        }
        name_ = setup.name;
        volts_ = metres_ = tactus::signal::LoudestRms(static_cast<std::size_t>(0.25 * setup.rate()));
    }

    void process(const Tick& tick) noexcept {
        const double volts = gain;
        for (int i = 0; i < tick.frames; ++i) {
            const vibration::ActuatorOutput out = output(volts * signal::finite_or_zero(drive[i]));
            voltage[i] = signal::to_sample(out.voltage);
            signal[i] = signal::to_sample(out.acceleration);
            current[i] = signal::to_sample(out.current);
            limited_ += out.limited;
            volts_(out.voltage);
            metres_(out.acceleration);
        }
    }

    void report(Report& report) const {
        report.set(name_, "limited_samples", static_cast<double>(limited_));
        report.set(name_, "loudest_rms_V", volts_.value());
        report.set(name_, "loudest_rms_m_s2", metres_.value());
        if (metres_.value() > 0.0 && metres_.value() < tactus::signal::touch_of_grasp)
            report.set(name_, "note",
                       fmt::format("the handle vibrates with {:.2g} m/s^2 rms where it is loudest, below what a hand "
                                   "feels, about {:g} m/s^2",
                                   metres_.value(), tactus::signal::touch_of_grasp));
    }

private:
    static constexpr std::size_t plant_taps = 4096;

    static void override_with(double& value, double given) {
        if (given > 0.0) value = given;
    }

    /// Refuses a parameter that the plant does not have.
    static void refuse(const Param& param, const char* name, const char* plant) {
        if (param > 0.0) throw Error(fmt::format("'{}' does not apply to {}; remove it", name, plant));
    }

    /// Refuses what only a mass on a spring in a coil has.
    void refuse_moving_parts(const char* plant) const {
        refuse(moving_mass, "moving_mass", plant);
        refuse(resonance, "resonance", plant);
        refuse(damping, "damping", plant);
        refuse(q, "q", plant);
        refuse(force_factor, "force_factor", plant);
        refuse(inductance, "inductance", plant);
        refuse(current_limit, "current_limit", plant);
        refuse(force_limit, "force_limit", plant);
    }

    /// A mass on a spring in a coil.
    void moving(const Setup& setup) {
        vibration::ActuatorModel data =
            vibration::find_actuator(preset.options[static_cast<std::size_t>(preset.index)]);
        override_with(data.moving_mass, moving_mass);
        override_with(data.resistance, resistance);
        override_with(data.inductance, inductance);
        override_with(data.voltage_limit, voltage_limit);
        override_with(data.current_limit, current_limit);
        override_with(data.force_factor, force_factor);
        if (q > 0.0 && damping > 0.0) throw Error("give 'q' or 'damping', not both: each follows from the other");
        const double ratio = q > 0.0 ? 0.5 / q : static_cast<double>(damping);
        vibration::ActuatorMechanics mechanics;
        if (data.force_factor > 0.0 && resonance > 0.0 && ratio > 0.0) {
            // Nothing of the preset's mechanics is left.
            data.resonance = resonance;
            data.damping = ratio;
            data.resonance_mass = mass;
            mechanics = vibration::mechanics_of(data);
        } else {
            mechanics = vibration::mechanics_of(data);
            if (resonance > 0.0 || ratio > 0.0) {
                double frequency = vibration::resonance_on(data, mass).frequency;
                override_with(frequency, resonance);
                mechanics = vibration::tuned(data, mechanics, mass, frequency, ratio);
            }
        }
        if (force_limit > 0.0) data.current_limit = std::min(data.current_limit, force_limit / mechanics.force_factor);
        actuator_ = tactus::vibration::Actuator(data, mechanics, mass, setup.rate());
    }

    void rotating(const Setup& setup) {
        refuse_moving_parts("a rotating mass, which shakes at the rate at which it turns");
        vibration::RotatingMassModel data = vibration::coin_erm;
        override_with(data.resistance, resistance);
        override_with(data.voltage_limit, voltage_limit);
        rotating_.emplace(data, mass, setup.rate());
    }

    void measured(const Setup& setup) {
        constexpr const char* plant = "a measured response, which is that of one actuator on one handle";
        refuse_moving_parts(plant);
        refuse(resistance, "resistance", plant);
        if (const std::string& unit = response->unit; !unit.empty() && !unit.starts_with("m/s^2"))
            throw Error(fmt::format("the measured response is in {}, not in m/s^2 per V", unit));
        plant_.emplace(vibration::impulse_response(response->identified.response, setup.rate(), plant_taps));
        plant_limit_ = voltage_limit > 0.0 ? static_cast<double>(voltage_limit) : voltage_limit.max;
    }

    vibration::ActuatorOutput output(double volts) noexcept {
        if (rotating_) return (*rotating_)(volts);
        if (!plant_) return actuator_(volts);
        vibration::ActuatorOutput out;
        out.voltage = std::clamp(volts, -plant_limit_, plant_limit_);
        out.limited = out.voltage != volts;
        out.acceleration = static_cast<double>((*plant_)(static_cast<float>(out.voltage)));
        return out;
    }

    tactus::vibration::Actuator actuator_;
    std::optional<tactus::vibration::RotatingMass> rotating_;
    std::optional<tactus::signal::Fir> plant_;
    double plant_limit_ = 0.0;  // V
    std::int64_t limited_ = 0;
    tactus::signal::LoudestRms volts_, metres_;  // of a quarter of a second
    std::string name_;
};

TACTUS_NODE(Actuator, drive, voltage, signal, current, actuator, preset, response, gain, mass, moving_mass, resonance,
            damping, q, force_factor, resistance, inductance, voltage_limit, current_limit, force_limit)

}  // namespace tactus::nodes

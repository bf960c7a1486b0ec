// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/actuator.hpp"

#include "dsp/signal/filter/loudest_rms.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "dsp/signal/spectrum/perception.hpp"
#include "graph/node/node.hpp"

#include <fmt/format.h>

namespace tactus::nodes {

struct Actuator {
    static constexpr auto about =
        "Model of a voice-coil actuator on a handle: the voltage of its amplifier and the acceleration of the handle.";

    In<Signal> drive{"signal to play"};
    Out<Signal> voltage{"output of the amplifier", "V"};
    Out<Signal> signal{"acceleration of the handle", "m/s^2"};
    Out<Signal> current{"in the coil", "A"};
    Text actuator{"", "name of an entry of [actuators], which has the settings that are not given here"};
    Choice preset{{"haptuator_small", "haptuator_large", "markII_D"},
                  "data of the actuator; used for parameters that are 0"};
    Param gain{"1 V", "-100 V", "100 V", "drive voltage per unit of the signal"};
    Param mass{structural, "100 g", "1 g", "10 kg", "total vibrating mass: handle, housing and moving mass"};
    Param moving_mass{structural, "0 g", "0 g", "10 kg", "in the housing; the resonance depends on both masses"};
    Param resonance{structural, "0 Hz", "0 Hz", "2 kHz", "on this handle at a constant voltage, back-EMF included"};
    Param damping{structural, "0", "0", "10", "damping ratio on this handle, back-EMF included"};
    Param resistance{structural, "0 ohm", "0 ohm", "1 kohm", "of the coil"};
    Param inductance{structural, "0 mH", "0 mH", "1 H", "of the coil"};
    Param voltage_limit{structural, "0 V", "0 V", "100 V", "of the amplifier"};
    Param current_limit{structural, "0 A", "0 A", "100 A", "of the coil"};

    void prepare(const Setup& setup) {
        try {
            vibration::ActuatorModel data =
                vibration::find_actuator(preset.options[static_cast<std::size_t>(preset.index)]);
            override_with(data.moving_mass, moving_mass);
            override_with(data.resistance, resistance);
            override_with(data.inductance, inductance);
            override_with(data.voltage_limit, voltage_limit);
            override_with(data.current_limit, current_limit);
            vibration::ActuatorMechanics mechanics = vibration::mechanics_of(data);
            if (resonance > 0.0 || damping > 0.0) {
                double frequency = vibration::resonance_on(data, mass).frequency;
                override_with(frequency, resonance);
                mechanics = vibration::tuned(data, mechanics, mass, frequency, damping);
            }
            actuator_ = tactus::vibration::Actuator(data, mechanics, mass, setup.rate());
        } catch (const Error& error) {
            setup.fail(error.message());
        }
        name_ = setup.name;
        volts_ = metres_ = tactus::signal::LoudestRms(static_cast<std::size_t>(0.25 * setup.rate()));
    }

    void process(const Tick& tick) noexcept {
        const double volts = gain;
        for (int i = 0; i < tick.frames; ++i) {
            const vibration::ActuatorOutput out = actuator_(volts * signal::finite_or_zero(drive[i]));
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
    static void override_with(double& value, double given) {
        if (given > 0.0) value = given;
    }

    tactus::vibration::Actuator actuator_;
    std::int64_t limited_ = 0;
    tactus::signal::LoudestRms volts_, metres_;  // of a quarter of a second
    std::string name_;
};

TACTUS_NODE(Actuator, drive, voltage, signal, current, actuator, preset, gain, mass, moving_mass, resonance, damping,
            resistance, inductance, voltage_limit, current_limit)

}  // namespace tactus::nodes

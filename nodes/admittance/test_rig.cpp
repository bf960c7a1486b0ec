// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/gripper/rig.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct TestRig {
    static constexpr auto about =
        "Test rig: a servo swings a cord with two springs that hold the finger of a gripper (thesis 6.3.4.1). Connect "
        "'cord' to gripper_output.cord.";

    In<double> finger{optional, "position of the finger, for the spring force", "m"};
    Out<double> cord{"position of the cord at the end of this tick", "m"};
    Out<double> spring_force{"of the springs on a finger at that position, with the cord as it is now", "N"};
    Out<double> swing_rate{"present rate of the swing", "Hz"};
    Param peak_to_peak{"50 mm", "0 mm", "1 m", "travel of the cord"};
    Param swings{"1 Hz", "0 Hz", "50 Hz", "rate of the swing; the phase is continuous when it changes"};
    Param sweep_to{structural, "0 Hz", "0 Hz", "50 Hz",
                   "rate at the end of a logarithmic sweep that starts at 'swings'; 0: no sweep"};
    Param sweep_time{structural, "60 s", "1 s", "1 h", "duration of the sweep"};
    Param spring{internal, "0.19 N/mm", "0 N/mm", "10 N/mm", "of each of the two springs"};
    Param pretension{"35 mm", "0 mm", "1 m", "stretch of each spring at rest; beyond it one spring is slack"};

    void prepare(const Setup&) { publish(0.0, swings); }

    void process(const Tick& tick) noexcept {
        const double rate = rate_at(tick.time_seconds());
        const double now = swing_.at(0.5 * peak_to_peak);
        fastest_ = std::max(fastest_, simulate::peak_cord_speed(peak_to_peak, rate));
        publish(now, rate);
        cord = swing_.advance(0.5 * peak_to_peak, rate, tick.elapsed_seconds());
    }

    void report(Report& report) const {
        report.set("rig", "peak_cord_speed_mm_s", fastest_ * 1e3);
        report.set("rig", "stiffness_N_per_mm", simulate::RigSprings{spring, pretension}.at_finger() * 1e-3);
    }

private:
    double rate_at(double time) const noexcept {
        if (!(sweep_to > 0.0) || !(swings > 0.0)) return swings;
        return swings * std::pow(sweep_to / swings, std::clamp(time / sweep_time, 0.0, 1.0));
    }
    void publish(double now, double rate) noexcept {
        cord = now;
        swing_rate = rate;
        spring_force = finger.connected ? simulate::RigSprings{spring, pretension}.force(now, finger) : 0.0;
    }

    simulate::CordSwing swing_;
    double fastest_ = 0.0;
};

TACTUS_NODE(TestRig, finger, cord, spring_force, swing_rate, peak_to_peak, swings, sweep_to, sweep_time, spring,
            pretension)

}  // namespace tactus::nodes

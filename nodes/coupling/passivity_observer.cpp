// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/passivity.hpp"

#include "graph/node/node.hpp"

#include <algorithm>

namespace tactus::nodes {

struct PassivityObserver {
    static constexpr auto about =
        "Passivity observer and controller (time-domain passivity approach, Hannaford and Ryu 2002): sums the energy "
        "that the hand puts in by translation and rotation. Force and torque that would give more are shrunk, and what "
        "is missing all the same is taken back by dampers.";

    In<Wrench> in{"computed wrench on the hand", "N, N m"};
    In<Pose> hand{"pose of the hand in the frame of the wrench", "m"};
    Out<Wrench> wrench{"on the hand, with the damping force", "N, N m"};
    Out<double> energy{"put in by the hand so far; negative: the scene is active", "J"};
    Out<double> brake{"damping added in this tick", "N s/m"};
    Out<double> angular_brake{"rotational damping added in this tick", "N m s/rad"};
    Flag control{true, "shrink and add damping; false: only observe"};
    Param max_damping{"50 N s/m", "0 N s/m", "500 N s/m", "limit of the damping"};
    Param max_angular_damping{
        "0.02 N m s/rad", "0 N m s/rad", "5 N m s/rad",
        "limit of the rotational damping; above the inertia of the handle divided by the period it "
        "would itself be unstable"};

    void process(const Tick& tick) noexcept {
        const auto now = observer_(in, hand, std::max(tick.elapsed_seconds(), seconds(tick.period)), control,
                                   {max_damping, max_angular_damping});
        wrench = now.wrench;
        energy = now.energy;
        brake = now.damping;
        angular_brake = now.angular_damping;
        least_ = std::min(least_, now.energy);
    }

    void report(Report& report) const { report.set("passivity", "least_energy_J", least_); }

private:
    tactus::coupling::PassivityObserver observer_;
    double least_ = 0.0;
};

TACTUS_NODE(PassivityObserver, in, hand, wrench, energy, brake, angular_brake, control, max_damping,
            max_angular_damping)

}  // namespace tactus::nodes

// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/passivity.hpp"

#include "graph/node/node.hpp"

#include <algorithm>

namespace tactus::nodes {

struct PassivityObserver {
    static constexpr auto about =
        "Counts the energy that goes to the hand and comes from it; when more came than went, it can brake the hand "
        "with "
        "just the damping that is missing (Hannaford and Ryu 2002).";

    In<Wrench> in{"on the hand, as computed", "N, N m"};
    In<Pose> hand{"in the frame of the wrench", "m"};
    Out<Wrench> wrench{"on the hand, with the brake", "N, N m"};
    Out<double> energy{"put in by the hand so far; below zero the scene is active", "J"};
    Out<double> brake{"damping in this tick", "N s/m"};
    Flag control{true, "brake; otherwise only count"};
    Param max_damping{"50 N s/m", "0 N s/m", "500 N s/m", "of the brake"};

    void process(const Tick& tick) noexcept {
        const auto now =
            observer_(in, hand, std::max(tick.elapsed_seconds(), seconds(tick.period)), control, max_damping);
        wrench = now.wrench;
        energy = now.energy;
        brake = now.damping;
        least_ = std::min(least_, now.energy);
    }

    void report(Report& report) const { report.set("passivity", "least_energy_J", least_); }

private:
    tactus::coupling::PassivityObserver observer_;
    double least_ = 0.0;
};

TACTUS_NODE(PassivityObserver, in, hand, wrench, energy, brake, control, max_damping)

}  // namespace tactus::nodes

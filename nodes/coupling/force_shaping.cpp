// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/force_shape.hpp"

#include "graph/node/node.hpp"

#include <cmath>
#include <numbers>

namespace tactus::nodes {

struct ForceShaping {
    static constexpr auto about =
        "Scales a wrench, takes off what shakes faster than a hand can follow, and levels it off softly below the "
        "limits "
        "of a device.";

    In<Wrench> in{"what is to be felt", "N, N m"};
    Out<Wrench> wrench{"shaped", "N, N m"};
    Param gain{"1", "0", "10", "factor of force and torque"};
    Param straight_force{"6 N", "0 N", "100 N", "forces up to here pass unchanged"};
    Param max_force{"10 N", "0 N", "100 N", "forces approach this and never exceed it"};
    Param straight_torque{"0.3 N m", "0 N m", "20 N m", "torques up to here pass unchanged"};
    Param max_torque{"0.5 N m", "0 N m", "20 N m", "torques approach this and never exceed it"};
    Param cutoff{"0 Hz", "0 Hz", "10 kHz", "of a low-pass of first order, which delays; 0: none"};

    void process(const Tick& tick) noexcept {
        const Wrench now = is_finite(in.get()) ? in.get() * gain : Wrench{};
        // Exact for an input that holds between ticks.
        const double share =
            cutoff > 0.0 ? -std::expm1(-2.0 * std::numbers::pi * cutoff * tick.elapsed_seconds()) : 1.0;
        smooth_ = smooth_ + (now + smooth_ * -1.0) * share;
        if (!is_finite(smooth_)) smooth_ = {};
        wrench = {coupling::soft_limit(smooth_.force, straight_force, max_force),
                  coupling::soft_limit(smooth_.torque, straight_torque, max_torque)};
    }

private:
    Wrench smooth_;
};

TACTUS_NODE(ForceShaping, in, wrench, gain, straight_force, max_force, straight_torque, max_torque, cutoff)

}  // namespace tactus::nodes

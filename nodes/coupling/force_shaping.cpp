// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/force_shape.hpp"

#include "graph/node/node.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::nodes {

struct ForceShaping {
    static constexpr auto about =
        "Shapes a wrench for a device: gain, low-pass against vibration, and a soft limit below that of a device. A "
        "wrench that is not finite is passed on, so that device_output takes the force away.";

    In<Wrench> in{"the wrench to shape", "N, N m"};
    Out<Wrench> wrench{"the shaped wrench", "N, N m"};
    Param gain{"1", "0", "10", "factor of force and torque"};
    Param straight_force{"6 N", "0 N", "100 N", "smaller forces pass unchanged"};
    Param max_force{"10 N", "0 N", "100 N", "upper bound of the force, which it approaches smoothly"};
    Param straight_torque{"0.3 N m", "0 N m", "20 N m", "smaller torques pass unchanged"};
    Param max_torque{"0.5 N m", "0 N m", "20 N m", "upper bound of the torque, which it approaches smoothly"};
    Param cutoff{"0 Hz", "0 Hz", "10 kHz", "of a first-order low-pass, which adds delay; 0: none"};

    void process(const Tick& tick) noexcept {
        const Wrench now = in.get() * gain;
        if (!is_finite(now)) {
            wrench = now;
            return;
        }
        // Exact for an input that is constant between ticks.
        const double share =
            cutoff > 0.0 ? -std::expm1(-2.0 * std::numbers::pi * cutoff * tick.elapsed_seconds()) : 1.0;
        smooth_ = smooth_ + (now + smooth_ * -1.0) * share;
        if (!is_finite(smooth_)) {
            wrench = std::exchange(smooth_, {});
            return;
        }
        wrench = {coupling::soft_limit(smooth_.force, straight_force, max_force),
                  coupling::soft_limit(smooth_.torque, straight_torque, max_torque)};
    }

private:
    Wrench smooth_;
};

TACTUS_NODE(ForceShaping, in, wrench, gain, straight_force, max_force, straight_torque, max_torque, cutoff)

}  // namespace tactus::nodes

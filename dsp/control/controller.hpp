// SPDX-License-Identifier: Apache-2.0
// Admittance control of one finger (thesis figure 39): force → virtual object → position loop → speed of the motor.
#pragma once

#include "dsp/control/force_limiter.hpp"
#include "dsp/control/loop_stability.hpp"
#include "dsp/control/position_loop.hpp"
#include "dsp/control/switched_loop.hpp"
#include "dsp/control/virtual_object.hpp"

namespace tactus::control {

struct ControllerSettings {
    ObjectSettings object;
    LoopModel loop;  ///< model of motor and hand; gain 0: gain_share of the limit
    double gain_share = 0.5;    ///< of the limit, below 1
    double max_speed = 0.07;    ///< m/s
    double least_speed = 0.0;   ///< m/s, see PositionLoopSettings
    double blend = 0.1;  ///< s, time constant with which a jump of the wanted position decays
    bool allow_unstable = false;
    double stuck_speed = 0.04;  ///< m/s; an encoder that does not change while the command is faster than this …
    double stuck_travel = 0.008;  ///< … over this distance, m, counts as stuck …
    double stall_force = 2.0;  ///< N … unless the hand resists with this force: then the motor may be stalled

    bool operator==(const ControllerSettings&) const = default;
};

/// The loop as it is simulated: with the speed of the motor.
LoopModel loop_of(const ControllerSettings& settings) noexcept;

class AdmittanceControl {
public:
    /// Takes new settings without a jump of the wanted position. False: they cannot be rendered, or the loop would be
    /// unstable and that is not allowed; the old ones stay. The loop of a one-sided object is simulated before it is accepted;
    /// a gain that is chosen here is lowered until it settles. Real-time safe.
    bool set(const ControllerSettings& settings) noexcept;

    /// Speed for the motor, m/s, after `periods` periods. `sensed` is the fault of the sensors; `slips`: the load moves
    /// the finger against the motor, so a finger at rest is no fault. On any fault the motor holds and the first reason
    /// stays.
    double tick(double force, double position, Fault sensed, int periods, bool slips = false) noexcept;
    /// Resumes after a fault that has gone, from the finger's position. Wait-free.
    void recover() noexcept { asked_ = true; }

    double wanted() const noexcept { return wanted_; }
    bool saturated() const noexcept { return loop_.saturated; }
    Fault fault() const noexcept { return fault_; }
    double gain() const noexcept { return gain_; }
    double limit() const noexcept { return limit_; }  ///< of the gain, 1/s

private:
    double limit_for(const ControllerSettings& settings) const noexcept;
    bool settles_at(double gain, const ControllerSettings& settings) const noexcept;
    bool is_stuck(double force, double position, bool slips) noexcept;
    double follow(double force, double position, int periods) noexcept;

    ControllerSettings settings_;
    VirtualObject object_;
    PositionLoop loop_;
    double gain_ = 0.0, limit_ = 0.0;
    double wanted_ = 0.0, offset_ = 0.0, force_ = 0.0;
    double told_ = 0.0, told_travel_ = 0.0, seen_travel_ = 0.0, position_ = 0.0;
    Fault fault_ = Fault::none;
    bool engaged_ = false, asked_ = false;
};

}  // namespace tactus::control

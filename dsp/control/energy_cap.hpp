// SPDX-License-Identifier: Apache-2.0
// Last stage before the device's own limit: a hand gets no more energy out of a contact than it has put in.
#pragma once

#include "dsp/control/adaptive_window.hpp"
#include "dsp/control/stated_hand.hpp"
#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus::control {

struct EnergyCapSettings {
    double period_s = 0.001;
    double resolution = 20e-6;          ///< m, step of the reported position
    double angular_resolution = 200e-6; ///< rad, step of the reported orientation
    double delay_s = 0.0;               ///< of the device: from a motion to its sample plus from a force to the hand
    double damping = StatedHand::damping;       ///< N·s/m, that a hand and its device have at least
    double min_mass = StatedHand::mass;       ///< kg, of the lightest hand with its device, for the motion ahead
    double min_inertia = StatedHand::inertia; ///< kg·m²
};

struct EnergyCapStatistics {
    std::uint64_t capped = 0;        ///< ticks whose force or torque was shrunk
    double max_removed_force = 0.0;   ///< N, largest shrinking in a tick
    double max_removed_torque = 0.0;  ///< N·m
    double max_stored = 0.0;          ///< J
    double max_returned = 0.0;        ///< J beyond what was put in during one contact, by what the samples show
    double granted = 0.0;              ///< J given out of granted power
};

/// Passivity of the hand's port in the time domain, for forces that are held during a tick. The store is
///
///     E(n) = E(n − 1) − F(n − 1)·(x(n) − x(n − 1)) − τ(n − 1)·(θ(n) − θ(n − 1)),
///
/// F and τ as they were committed, x and θ as the samples show them. While the hand moves along the force, what the next
/// hold will give, by the motion extrapolated into it, must be in the store; otherwise force and torque are shrunk by
/// the ratio, at once. Observer: B. Hannaford, J.-H. Ryu, IEEE Trans. Robotics and Automation 18 (2002); the bound on the
/// energy of the next hold: J.-P. Kim, J. Ryu, Int. J. Robotics Research 29 (2010), "energy bounding algorithm".
///
/// - One store for force and torque: a contact on a lever takes energy in by translation and returns it by rotation.
/// - The motion ahead is that of the lightest hand: its velocity now, what the force of the last hold and the forces under
///   way add to it, and the force itself. A slow hand is trusted to hold against `rest_J` of that, not more: during a long
///   hold a hand that is let go gains many times as much (at 60 Hz 10 N give 0.1 kg 139 mJ).
/// - A sample is known to half a step only. While the hand is slow, its motion is the least that the samples allow, so
///   that noise of a step, and a hand that trembles, drain nothing; when it is fast, the samples are taken as they are.
/// - The store empties when the contact ends.
/// - Granted power refunds what the hand is given; what is not used within `grant_window_s` lapses.
class EnergyCap {
public:
    static constexpr double slow_m_s = 0.02;  ///< below: least motion; above twice this: samples as they are
    static constexpr double slow_rad_s = 0.4;
    static constexpr double calm_m_s = 0.05;  ///< below: what the hand damps is refunded; above twice this: nothing
    static constexpr double calm_s = 0.01;  ///< in which a hand that stops becomes a slow one
    static constexpr double rest_J = 1.5e-3;  ///< that a hold may give a slow hand which nobody holds
    static constexpr double end_force = 0.02;  ///< N and ...
    static constexpr double end_torque = 0.5e-3;  ///< N·m below which a contact is over
    static constexpr double grant_window_s = 0.02;
    static constexpr double return_s = 0.1;  ///< in which a force that was taken from a hand at rest comes back

    /// Forces of so many periods are remembered: a longer delay cannot be accounted for.
    static constexpr std::size_t max_delay = 64;
    static constexpr double longest_delay_s(double period_s) noexcept {
        return static_cast<double>(max_delay) * period_s;
    }

    /// Bound on the energy that a contact gives a hand of `damping` beyond 1.05 of what it took, J: with T the period, t_d the delay,
    /// m the lightest mass, q the step of the samples and F the largest force,
    ///
    ///     min(rest_J, F²·(T + t_d)²/m) + F·q + 0.2·F²·t_d·(T + t_d)/m
    ///
    /// A slow hand may be free; a sample is known to a step; and a delay that is no multiple of T hides where in a hold the
    /// force changed. `stiffness` N/m bounds F by what a hand of 1 m/s and that mass reaches, √(m·K) + K·(T + t_d) in N;
    /// infinite: `max_force` alone. Holds for every rate, delay and stiffness: tests/dsp/control/energy_bound.cpp.
    static double max_gain(const EnergyCapSettings& settings, double stiffness, double max_force) noexcept;

    /// `delay_s` is at most `longest_delay_s`.
    void prepare(const EnergyCapSettings& settings) noexcept;

    /// `wanted` is for the coming hold; `committed` is what the device has held since the last call, after all clamps.
    /// `granted_W` may be given without being put in. `was_taken`: another thread faded the force meanwhile. Returns
    /// `wanted` or less of it. Real-time safe.
    Wrench tick(const Wrench& wanted, const Wrench& committed, const Pose& hand, double elapsed_s, double granted_W,
                bool was_taken) noexcept;

    double stored() const noexcept { return stored_; }  ///< J
    const EnergyCapStatistics& statistics() const noexcept { return statistics_; }

private:
    static constexpr double farthest_m = 10.0, max_J = 1e6;

    /// Translation or rotation since the last call, and what is to be expected.
    struct Motion {
        Vec3 done{0.0};  ///< that counts for the store
        Vec3 lag{0.0};  ///< of what counts behind the sample
        Vec3 velocity{0.0};
        double fast = 0.0;  ///< 0: the hand is slow, and its motion is the least that the samples allow; 1: it is not
        double doubt = 0.0;  ///< of the motion in the coming hold, by the step of the samples
    };

    /// Position or orientation through the samples of a run.
    struct Tracked {
        AdaptiveWindow window;
        Vec3 sum{0.0};  ///< of what counted
        Vec3 velocity{0.0};
        double fast = 0.0;
    };

    Motion follow(const Vec3& away, double step, double slow, Tracked& tracked, double elapsed_s) noexcept;
    void start_over() noexcept;
    Wrench acting() const noexcept;
    void account(double work, double elapsed_s, double granted_W, bool was_taken) noexcept;
    Wrench under_way() const noexcept;
    double reserve() const noexcept;
    Wrench bound(const Wrench& felt, const Motion& moved, const Motion& turned, const Wrench& wanted) noexcept;

    EnergyCapSettings settings_;
    EnergyCapStatistics statistics_;
    Tracked place_, turn_;
    Pose counted_;  // the hand's, as far as its motion counts
    std::array<Wrench, max_delay + 2> held_{};  // committed forces, newest first
    double stored_ = 0.0, grant_ = 0.0, damped_ = 0.0, hold_s_ = 0.001;
    double force_level_ = 1.0, torque_level_ = 1.0;  // share that is felt after the cap has acted
    double doubt_ = 0.0;  // J², variance of the store by the steps of the samples
    bool started_ = false;
    bool is_blind_ = false, was_blind_ = false;  // the last sample, or one since the store was counted, was none
};

}  // namespace tactus::control

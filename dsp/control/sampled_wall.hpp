// SPDX-License-Identifier: Apache-2.0
// How stiff and how damped a wall can be that a computer renders once per period: what theory allows, and what simulated
// devices bear.
#pragma once

namespace tactus::control {

/// A mass with viscous and Coulomb friction against a wall of stiffness and damping whose force is held for a period.
struct SampledWall {
    double period = 1e-3;  ///< s
    double delay = 0.0;  ///< s, from a sample to the force
    double mass = 0.1;  ///< kg
    double viscous = 1.0;  ///< N·s/m, of the device
    double friction = 0.0;  ///< N, Coulomb, of the device
    double resolution = 0.0;  ///< m, encoder step
    double stiffness = 1000.0;  ///< N/m, of the wall
    double damping = 0.0;  ///< N·s/m, of the wall
    double press = 1.0;  ///< N, with which the hand leans on it
    double approach = 0.1;  ///< m/s, with which the hand reaches it
    double max_force = 1e9;  ///< N, of the device
};

/// Largest passive stiffness, N/m, in closed form: b > K T/2 + |B| (J. E. Colgate, G. G. Schenkel, J. Robotic Systems 14,
/// 1997), and K (T/2 + t_d) in place of K T/2 with a delay t_d (J. Gil et al., IEEE Trans. Control Systems Technology 17,
/// 2009). 0 when there is none.
double colgate_stiffness(const SampledWall& wall) noexcept;

/// Largest stiffness for which Coulomb friction takes what encoder steps give: K Δ/2 ≤ f (J. J. Abbott, A. M. Okamura,
/// IEEE Trans. Robotics 21, 2005; N. Diolaiti et al., IEEE Trans. Robotics 22, 2006). Infinite without steps.
double friction_stiffness(const SampledWall& wall) noexcept;

/// Both: nothing oscillates below it.
double quiet_stiffness(const SampledWall& wall) noexcept;

/// The same border as `colgate_stiffness` by motion: the hand is led along the paths that cost the device's damper the
/// least, straight between samples, at every frequency up to half of the sampling rate; the largest stiffness at which
/// device and wall never give energy. N/m.
double passive_stiffness(const SampledWall& wall) noexcept;

/// A hand that hits the wall with `approach` and leans on it with `press` is still in motion after 2 s, by more than encoder
/// steps explain.
bool oscillates(const SampledWall& wall) noexcept;

/// The lowest stiffness at which a hand oscillates, and the hand that does.
struct SimulatedLimit {
    double stiffness = 0.0;  ///< N/m; `max` where none oscillates
    double press = 0.0;  ///< N
    double approach = 0.0;  ///< m/s
};

/// The worst over presses from 0.5 N to 0.8 of the device's largest force, beyond which no wall holds a hand (of 10 N for a
/// device that states none), and approaches up to 0.3 m/s. Friction that stops a light press may not stop a firm one, and
/// the other way round: no single press stands for all. `wall.press` and `wall.approach` are ignored. Searches up to `max` N/m.
SimulatedLimit simulated_stiffness(SampledWall wall, double max) noexcept;

}  // namespace tactus::control

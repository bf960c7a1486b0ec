// SPDX-License-Identifier: Apache-2.0
// Stability of an admittance loop: hand, virtual object, sampled position loop, delay and motor as one linear system,
// judged by its spectral radius.
#pragma once

#include "dsp/control/virtual_object.hpp"

#include <array>
#include <cstddef>

namespace tactus::control {

/// The loop of thesis figure 39. Each period: force and position are sampled, the object makes one exact step, the
/// motor gets u = gain (x_d − x) + feed_forward · (low-passed velocity of x_d), and follows it `delay` periods later.
struct LoopModel {
    double period = 1.0 / 150.0;          ///< s
    double gain = 40.0;                   ///< 1/s
    int delay = 1;                        ///< whole periods between sample and motion, 0 to 8
    double motor_lag = 0.002;             ///< s, time constant of the motor's speed
    double hand_stiffness = 3000.0;  ///< N/m, of the stiffest finger; fingers are between 200 and 3000 N/m
    double feed_forward = 0.0;            ///< share of the object's velocity
    double feed_forward_lag = 0.0;        ///< s, time constant of its smoothing
    bool is_wall = false;  ///< the object does not move; stiffness, damping and mass are ignored
    double stiffness = 1000.0, damping = 0.0, mass = 0.0;  ///< of the object: N/m, N·s/m, kg
    double max_speed = 0.0;  ///< m/s of the motor; 0: no bound. Only a simulation uses it: a linear loop has none

    bool operator==(const LoopModel&) const = default;
};

inline constexpr std::size_t max_loop_states = 14;

struct LoopMatrix {
    std::array<std::array<double, max_loop_states>, max_loop_states> at{};
    std::size_t size = 0;
};

/// Transition matrix from one period to the next.
LoopMatrix loop_matrix(const LoopModel& model) noexcept;

/// Spectral radius by Gelfand's formula: ‖A^(2^n)‖^(1/2^n). Real-time safe.
double spectral_radius(const LoopMatrix& matrix) noexcept;

/// The spectral radius is below 1 − 1e-6. Real-time safe.
bool is_stable(const LoopModel& model) noexcept;

/// Stability limit of the gain, 1/s, independent of `model.gain`; 0 when no gain is stable. Real-time safe.
double gain_limit(LoopModel model) noexcept;

/// The same for an ideal motor and a pure spring, in closed form: K dt < 2 sin(π/(2(2D+1))) / (1 + k_hand/k).
double ideal_gain_limit(double period, int delay, double hand_stiffness, double stiffness) noexcept;

/// The lowest gain limit over all states of the object: in contact, and free before it when it is one-sided.
double gain_limit(const LoopModel& model, const ObjectSettings& object) noexcept;

}  // namespace tactus::control

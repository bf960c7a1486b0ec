// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the hand: the daily values of ISO 5349-1 and of directive 2002/44/EC. Accelerations in m/s²,
// weighted by Wh, times in s.
#pragma once

#include <span>

namespace tactus::signal {

inline constexpr double reference_day = 8.0 * 3600.0;  ///< s

/// Values of directive 2002/44/EC: employers must act above the first; the second must never be exceeded.
struct ExposureLimits {
    double action, limit;
};
inline constexpr ExposureLimits hand_arm_limits{2.5, 5.0};  ///< m/s² A(8)

/// Exposure to one tool on one day.
struct HandArmOperation {
    double acceleration = 0.0;  ///< vibration total value a_hv, m/s²
    double duration = 0.0;  ///< of contact per day, s
};

/// a_hv = √(Σ a_hw²) of the axes.
double vibration_total(std::span<const double> axes);
/// A(8) = √(Σ a² T / 8 h), m/s².
double daily_exposure(std::span<const HandArmOperation> operations);
/// Time (s) at which `acceleration` alone makes A(8) reach `value`; infinity for 0.
double time_to_reach(double value, double acceleration);
/// Years until one in ten exposed persons has white fingers, 31.8 A(8)^−1.06 (ISO 5349-1, annex C).
double years_to_white_fingers(double a8);

}  // namespace tactus::signal

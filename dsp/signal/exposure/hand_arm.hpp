// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the hand: the weighting Wh of ISO 8041-1 and the daily figures of ISO 5349-1 and of directive
// 2002/44/EC. Accelerations in m/s², times in s.
#pragma once

#include "dsp/signal/filter/biquad.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <array>
#include <complex>
#include <span>

namespace tactus::signal {

/// Wh at `frequency` (Hz): band limits, then the acceleration-velocity transition. 1 means unweighted.
std::complex<double> hand_arm_weighting(double frequency);

/// Limits of the one-third octave bands 6.3 Hz to 1250 Hz of the weighted value: 10^0.75 and 10^3.15 Hz.
inline constexpr double hand_arm_lowest = 5.623413251903491, hand_arm_highest = 1412.5375446227544;

/// Wh as a filter (bilinear transform of its three sections): within 0.3 % of the definition from 6.3 to 1000 Hz at
/// 44.1 kHz and above, 8 % off at 8 kHz.
class HandArmFilter {
public:
    explicit HandArmFilter(double rate);
    double operator()(double x) noexcept { return sections_[2](sections_[1](sections_[0](x))); }
    std::complex<double> response(double frequency) const;

private:
    double rate_;
    std::array<Biquad, 3> sections_;
};

/// Root mean square weighted acceleration out of an acceleration density spectrum ((m/s²)²/Hz) that was
/// taken with a Hann window.
double weighted_acceleration(const Spectrum& density);

inline constexpr double reference_day = 8.0 * 3600.0;  ///< s
inline constexpr double action_value = 2.5;  ///< m/s² A(8): employers must act
inline constexpr double limit_value = 5.0;  ///< m/s² A(8): never to be exceeded

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

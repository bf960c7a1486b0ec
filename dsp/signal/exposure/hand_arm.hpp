// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the hand: the weighting Wh of ISO 8041-1 and the daily figures of ISO 5349-1 and of directive
// 2002/44/EC. Accelerations in m/s², times in s.
#pragma once

#include "dsp/signal/filter/biquad.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Wh at `frequency` (Hz): band limits, then the acceleration-velocity transition. 1 means unweighted.
std::complex<double> hand_arm_weighting(double frequency);

/// Limits of the one-third octave bands 6.3 Hz to 1250 Hz of the weighted value: 10^0.75 and 10^3.15 Hz.
inline constexpr double hand_arm_lowest = 5.623413251903491, hand_arm_highest = 1412.5375446227544;

/// Wh as a filter of three sections. Gain within 0.1 % of the definition from 6.3 to 1250 Hz at 44.1 kHz and above,
/// 0.5 % at 20 kHz, 3 % at 8 kHz.
class HandArmFilter {
public:
    explicit HandArmFilter(double rate);
    double operator()(double x) noexcept { return sections_[2](sections_[1](sections_[0](x))); }
    std::complex<double> response(double frequency) const;

private:
    double rate_;
    std::array<Biquad, 3> sections_;
};

/// Root mean square weighted acceleration of a record, in two ways that agree: the filter above, with zero state at the
/// start of each piece, and the Fourier transform of the pieces with the definition of Wh. Both contain how the
/// weighting rings on after the end. The transform takes at most 2^21 samples at a time.
class WeightedRecord {
public:
    /// `mean`: of the whole record; it is no vibration, and its onset would excite the weighting.
    WeightedRecord(double rate, double mean);

    void push(std::span<const double> samples);
    /// Call before a gap, and at the end of the record.
    void end_piece();
    double by_transform() const;
    double by_filter() const;

private:
    static constexpr std::size_t longest_block = std::size_t{1} << 21;
    void transform();
    std::size_t tail() const;

    double rate_, mean_;
    HandArmFilter filter_;
    std::vector<double> held_;
    std::size_t count_ = 0, in_piece_ = 0;
    double transformed_ = 0.0, filtered_ = 0.0;
};

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

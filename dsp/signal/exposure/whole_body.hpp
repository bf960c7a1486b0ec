// SPDX-License-Identifier: Apache-2.0
// Vibration exposure of the whole body: axes and the crest-factor rule of ISO 2631-1, comfort in trains of ISO 2631-4,
// and the daily values of directive 2002/44/EC. Accelerations in m/s², doses in m/s^1.75, times in s.
#pragma once

#include "dsp/signal/exposure/hand_arm.hpp"
#include "dsp/signal/exposure/weighting.hpp"

namespace tactus::signal {

inline constexpr ExposureLimits whole_body_limits{0.5, 1.15};  ///< m/s² A(8)
inline constexpr ExposureLimits whole_body_dose_limits{9.1, 21.0};  ///< m/s^1.75, VDV of a day

/// x forward, y left, z up, along the spine.
enum class BodyAxis { x, y, z };

/// Health of a seated or standing person (ISO 2631-1, clause 7), or comfort of a passenger of a train (ISO 2631-4).
enum class BodyJudgement { health, rail_comfort };

constexpr const Weighting& body_weighting(BodyJudgement judgement, BodyAxis axis) {
    if (axis != BodyAxis::z) return weighting_d;
    return judgement == BodyJudgement::health ? weighting_k : weighting_b;
}

/// Multiplying factor k of the axis: 1.4 for the horizontal axes of health, else 1.
constexpr double body_factor(BodyJudgement judgement, BodyAxis axis) {
    return judgement == BodyJudgement::health && axis != BodyAxis::z ? 1.4 : 1.0;
}

/// Measures of one axis of a record, weighted, without the factor.
struct BodyAxisVibration {
    double rms = 0.0;  ///< a_w
    double peak = 0.0;  ///< of the weighted acceleration
    double running = 0.0;  ///< MTVV
    double dose = 0.0;  ///< VDV of the measurement
    double seconds = 0.0;  ///< duration of the measurement

    double crest() const;
    /// MTVV / a_w and VDV / (a_w T^¼): above 1.5 or 1.75, the MTVV or the dose must be reported in addition to the rms.
    double running_ratio() const;
    double dose_ratio() const;
    /// ISO 2631-1, 6.2.1 and 6.3.3: true if the rms alone underestimates this vibration, because its crest factor is
    /// above 9 or one of the ratios above its limit.
    bool has_shocks() const;
    /// VDV of an exposure of this duration (s): the dose grows with the fourth root of time.
    double dose_of(double duration) const;
};

/// Time (s) after which `vibration`, with the factor `k` of its axis, reaches a dose; infinity for none.
double time_to_dose(double dose, const BodyAxisVibration& vibration, double k);

}  // namespace tactus::signal

// SPDX-License-Identifier: Apache-2.0
// How strong a vibration must be to be felt, over frequency.
#pragma once

namespace tactus::signal {

/// Parametric threshold of touch used for vibrotactile quality scores (Noll et al. 2021; the constants of vibromaf):
/// dB, −77 at 250 Hz, where touch is keenest, rising to both sides; above about 781 Hz it stays at 0. It is meant for a
/// recording of full scale ±1, not for a physical unit.
double touch_threshold_db(double hz) noexcept;
/// The same without its end: above 781 Hz it goes on rising.
double touch_curve_db(double hz) noexcept;

/// What the threshold curve is taken to be a threshold of. Published thresholds are flat in acceleration from 40 to
/// 250 Hz and fall 12 dB per octave in displacement; the curve above falls like displacement, although programs apply
/// it to acceleration.
enum class ThresholdUnit {
    displacement,  ///< the curve holds for displacement; an acceleration is integrated twice before
    acceleration,  ///< the curve is applied to the acceleration itself
    none,  ///< every frequency counts alike
};

/// How much a component of an acceleration at `hz` weighs in the hand, dB relative to one at 250 Hz.
double touch_weight_db(double hz, ThresholdUnit unit) noexcept;

}  // namespace tactus::signal

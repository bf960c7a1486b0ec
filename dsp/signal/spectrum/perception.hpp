// SPDX-License-Identifier: Apache-2.0
// Perceptual threshold of vibration over frequency.
#pragma once

namespace tactus::signal {

/// Parametric vibrotactile threshold used for quality scores (Noll et al. 2021; constants of vibromaf): dB, minimum −77
/// at 250 Hz, rising to both sides; 0 above about 781 Hz. For recordings with full scale ±1, not for a physical unit.
double touch_threshold_db(double hz) noexcept;
/// The same without the limit: above 781 Hz it keeps rising.
double touch_curve_db(double hz) noexcept;

/// m/s² rms: approximate threshold of a hand that grasps a handle at 100 to 300 Hz; sensitive people perceive less. At
/// 200 Hz, 0.01 to 0.1 µm of displacement (Brisben, Hsiao and Johnson 1999) are 0.02 to 0.2 m/s².
inline constexpr double touch_of_grasp = 0.05;

/// The quantity that the threshold curve refers to. Published thresholds are flat in acceleration from 40 to 250 Hz and
/// fall 12 dB per octave in displacement; the curve above falls like displacement, although implementations apply it to
/// acceleration.
enum class ThresholdUnit {
    displacement,  ///< the curve applies to displacement; an acceleration is integrated twice first
    acceleration,  ///< the curve applies to the acceleration itself
    none,  ///< all frequencies have equal weight
};

/// Perceptual weight of a component of an acceleration at `hz`, dB relative to one at 250 Hz.
double touch_weight_db(double hz, ThresholdUnit unit) noexcept;

}  // namespace tactus::signal

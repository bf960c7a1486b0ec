// SPDX-License-Identifier: Apache-2.0
// Calibration from touched points: poses of a screen, a mirror and a device's workspace in the viewer's world.
// All fits are least squares; they reject touches that do not determine the result, and say which.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/display/screen.hpp"

#include <glm/vec2.hpp>

#include <span>

namespace tactus::display {

/// Residuals of a fit, m.
struct TouchResidual {
    double rms = 0.0, worst = 0.0;
    std::size_t worst_touch = 0;  ///< index of the touch with the greatest residual
};

/// One position in two frames, m.
struct TouchPair {
    Vec3 from{0.0}, to{0.0};
};

struct RigidFit {
    Pose pose;  ///< maps `from` to `to`
    TouchResidual residual;
};
/// Rigid registration (Horn 1987). Needs three touches that are not collinear. Throws Error.
RigidFit fit_rigid(std::span<const TouchPair> touches);

struct AffineFit {
    Mat3 linear{1.0};
    Vec3 shift{0.0};  ///< from ↦ linear · from + shift
    TouchResidual residual;

    Vec3 apply(const Vec3& from) const { return linear * from + shift; }
};
/// Affine registration: includes scale and skew of a device. Needs four touches that are not coplanar.
/// Throws Error.
AffineFit fit_affine(std::span<const TouchPair> touches);

struct PlaneFit {
    Plane plane;  ///< through the mean of the touches; the normal points to the side of `towards`
    TouchResidual residual;
};
/// Plane fit to points on a mirror or table, at least three that are not collinear. Throws Error.
PlaneFit fit_plane(std::span<const Vec3> touches, const Vec3& towards);

/// A touched mark of a screen: where it was shown, (0, 0) lower left, (1, 1) upper right, and its position, m.
struct ScreenTouch {
    glm::dvec2 shown{0.0};
    Vec3 touched{0.0};
};
struct ScreenFit {
    Screen screen;  ///< an exact rectangle
    double skew_rad = 0.0;  ///< deviation of the touches' own axes from a right angle
    TouchResidual residual;
};
/// Needs three marks that are not collinear. Throws Error also when the touches are skewed by more than 3°.
ScreenFit fit_screen(std::span<const ScreenTouch> touches);

}  // namespace tactus::display

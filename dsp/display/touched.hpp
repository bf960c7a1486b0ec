// SPDX-License-Identifier: Apache-2.0
// Calibration from touched points: where a screen, a mirror and the workspace of a device are in the world of the viewer.
// All fits are least squares; touches that do not decide the answer are refused by name.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/display/screen.hpp"

#include <glm/vec2.hpp>

#include <span>

namespace tactus::display {

/// How well the touches agree with what was fitted, m.
struct TouchResidual {
    double rms = 0.0, worst = 0.0;
    std::size_t worst_touch = 0;  ///< number of the touch that is farthest off
};

/// One place known in two frames, m.
struct TouchPair {
    Vec3 from{0.0}, to{0.0};
};

struct RigidFit {
    Pose pose;  ///< takes `from` to `to`
    TouchResidual residual;
};
/// The best rotation and translation (Horn 1987). Needs three touches that do not lie on a line. Throws Error.
RigidFit fit_rigid(std::span<const TouchPair> touches);

struct AffineFit {
    Mat3 linear{1.0};
    Vec3 shift{0.0};  ///< from ↦ linear · from + shift
    TouchResidual residual;

    Vec3 apply(const Vec3& from) const { return linear * from + shift; }
};
/// The best affine map: takes up scales and skews of a device as well. Needs four touches that do not lie in a plane.
/// Throws Error.
AffineFit fit_affine(std::span<const TouchPair> touches);

struct PlaneFit {
    Plane plane;  ///< through the mean of the touches; the normal points to the side of `towards`
    TouchResidual residual;
};
/// A mirror or table from points on it, at least three that do not lie on a line. Throws Error.
PlaneFit fit_plane(std::span<const Vec3> touches, const Vec3& towards);

/// A touched mark of a screen: where it was shown, (0, 0) lower left, (1, 1) upper right, and where it was, m.
struct ScreenTouch {
    glm::dvec2 shown{0.0};
    Vec3 touched{0.0};
};
struct ScreenFit {
    Screen screen;  ///< a true rectangle
    double skew_rad = 0.0;  ///< by which the touches' own axes were not square
    TouchResidual residual;
};
/// Needs three marks that do not lie on a line. Throws Error also when the touches are skewed by more than 3°.
ScreenFit fit_screen(std::span<const ScreenTouch> touches);

}  // namespace tactus::display

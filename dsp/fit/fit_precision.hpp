// SPDX-License-Identifier: Apache-2.0
// Precision of a fit's pose, from the covariance of its least squares.
#pragma once

#include "dsp/fit/fit_surface.hpp"

#include <span>

namespace tactus::fit {

/// Two standard deviations of a fit's pose.
struct FitPrecision {
    double turn = 0.0;  ///< rad
    double far = 0.0;  ///< m, at the point of the moving fragment farthest from its face
    double face = 0.0;  ///< m, at the centroid of its face
};

/// Error bound of a fit's pose at 95 %. It includes the noise of the scans, and the second best pose if that is not
/// clearly worse: that pose may be a slip to the next relief, which a covariance does not contain.
struct PoseBound {
    double turn = 0.0;  ///< rad
    double face = 0.0, far = 0.0;  ///< m, at the centroid of the face and at the farthest point
    bool has_rival = false;  ///< the second best pose is included
};

/// `precision`: FitPrecisionSum::calibrated. `face`, `far`: these two points on the moving fragment, in its frame.
/// `margin`: of `best` to `rival`, as in FitSettings. `has_healthy`: a mirrored side took part, which naturally differs
/// from the broken one by 1.5 mm and 1°; the bound is at least that difference.
PoseBound bound_of(const FitPrecision& precision, double margin, const Pose& best, const Pose& rival, const Vec3& face,
                   const Vec3& far, bool has_healthy) noexcept;

/// Accumulates the faces of one moving fragment. The distances of a face scatter with the noise of its scan, which is
/// correlated over neighbouring points. Therefore the variance of their mean is summed over all pairs of points nearer
/// than 3 mm, with Bartlett's weights (Conley, J. Econometrics 92, 1999), and a face counts as the number of
/// independent points with that variance. Does not allocate.
class FitPrecisionSum {
public:
    /// `origin`, `far`: any point and the farthest point of the moving fragment, in the frame of all poses.
    FitPrecisionSum(const Vec3& origin, const Vec3& far) noexcept : origin_(origin), far_(far) {}

    /// `there`: pose of the fixed face's centroid; `into`: pose of the moving one in that frame, with the kerf closed.
    void add(const FitSurface& moving, const FitSurface& fixed, const Pose& there, const Pose& into) noexcept;
    /// Returns the precision; infinite where the faces leave a motion free. It includes the scatter of chipped areas,
    /// although the last steps of a fit exclude them: verdicts are on the safe side.
    FitPrecision precision() const noexcept;
    /// Returns the precision for a bound at 95 %: the geometric mean of the one above and of that without chipped areas
    /// (distances beyond three robust standard deviations), calibrated by shafts of different shapes with known poses
    /// (`tactus bench shafts --shapes`). With chips, the one above is 4 to 16 times the median error, and the other one is
    /// too small for a tenth of the poses.
    FitPrecision calibrated() const noexcept;

    static constexpr double lever = 0.01;  ///< m, makes rotations comparable to translations
    /// 6 × 6, inverse covariance of the pose: of translations in m, then of rotations about the origin in rad times `lever`.
    /// Zero if no faces are in contact.
    std::span<const double, 36> information() const noexcept { return information_; }

private:
    FitPrecision precision_of(std::span<const double, 36> information) const noexcept;

    Vec3 origin_, far_;
    double information_[36] = {}, intact_information_[36] = {};
    double voxel_ = 0.0;  // m, the coarsest of the scans
};

}  // namespace tactus::fit

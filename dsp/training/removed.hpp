// SPDX-License-Identifier: Apache-2.0
// What a saw removed of a bone, from the bone before and after: volumes, and the plane of the cut.
#pragma once

#include "dsp/training/planned_cut.hpp"
#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::training {

/// Two signed distances on the same samples: a bone before and after. Bone is what is negative.
struct CutBone {
    const volume::Grid& before;
    const volume::Grid& after;

    /// Interpolated distances at a point, m; 1 m outside of the grid.
    double before_at(const Vec3& p) const noexcept;
    double after_at(const Vec3& p) const noexcept;
    double smallest_spacing() const noexcept;
};

struct CutVolumes {
    double removed_m3 = 0.0;
    double over_m3 = 0.0;   ///< removed outside of the planned kerf widened by the tolerances
    double under_m3 = 0.0;  ///< of the planned kerf, at places where nothing within the tolerance was removed
};

/// The bone after one of several cuts: what was removed nearer to the planes of the others is bone again.
volume::Grid after_one_cut(const CutBone& bone, std::span<const PlannedCut> cuts, std::size_t cut);

/// A sample counts by the share of its voxel that the surface leaves in the bone, linear in the distance, so that the
/// volumes do not step with the voxels. Under-cut is the area of the planned plane in bone (down to the depth stop,
/// within a line), in cells of half a voxel, where no bone was removed within half a kerf and the tolerance, times the
/// kerf.
CutVolumes cut_volumes(const CutBone& bone, const PlannedCut& cut, double kerf);

/// One place on the middle surface of the cut.
struct CutPoint {
    Vec3 position;  ///< half way between the two walls, m
    double offset = 0.0;  ///< m from the planned plane, signed along its normal
    double width = 0.0;  ///< m between the walls
};

/// The plane of a cut.
struct CutPlane {
    Vec3 point{0.0, 0.0, 0.0}, normal{0.0, 0.0, 1.0};  ///< robust fit; the normal points as that of the plan
    std::vector<CutPoint> points;
    double rms = 0.0, max = 0.0;  ///< m, of the offsets of all points
    std::optional<double> angle;  ///< rad to the planned plane; none when the cut is too small to have a plane
};

/// Fits the plane of the actual cut: half way between its two walls, along lines across the cut, one per voxel. A place
/// counts where both walls were cut from bone; at the rim, where the bone's own surface ends the kerf, its middle would
/// be a false one. Walls come from interpolated distances, so they are known to a fraction of a voxel. The plane is a
/// least-squares fit with Tukey's biweight (4.685 standard deviations by the median absolute residual), from the main
/// axes of the removed volume on. Empty when less than 20 places count.
std::optional<CutPlane> fit_cut_plane(const CutBone& bone, const PlannedCut& cut, double kerf);

/// How far a cut goes through the bone, in its own plane.
struct Severance {
    bool severed = false;  ///< no bone is left in the plane within the length of the cut
    double exit = 0.0;  ///< m along the planned feed from the planned entry: the deepest bone that was there
    double low = 0.0, high = 0.0;  ///< m along the planned stroke: where it was cut
};

/// `reach` limits the search along the stroke to both sides of the middle of what was cut, m.
Severance severance_of(const CutBone& bone, const PlannedCut& cut, const CutPlane& plane, double reach);

}  // namespace tactus::training

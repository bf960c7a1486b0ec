// SPDX-License-Identifier: Apache-2.0
// Voxmap: the distance field around a body on a dense grid, against which pointshells are tested.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/core/types.hpp"
#include "dsp/volume/bricks.hpp"
#include "dsp/volume/grid.hpp"

#include <string_view>

namespace tactus::contact {

/// Signed distances to a body (m, negative inside) at the samples of a grid in the body's frame. Immutable. Values are
/// interpolated between samples and gradients are exact derivatives of the interpolant, so that forces derived from
/// them are conservative. Outside the grid the value is `far` with gradient 0: leave a margin of some voxels around the
/// surface, or let the field end where the body does not.
struct Voxmap {
    static constexpr std::string_view wire_name = "voxmap";

    volume::Grid grid;  ///< at least 2 samples per axis
    double far = 1.0;  ///< m, value outside the grid
    double steepness = 1.0;  ///< largest |difference| of neighbouring samples (26) per distance, at least 1

    /// Returns the trilinear value and its exact gradient. `position` in the body's frame, m.
    volume::Sample sample(const Vec3& position) const noexcept;
    /// The same with a quadratic B-spline over 27 samples (border repeated): continuous gradient.
    volume::Sample smooth_sample(const Vec3& position) const noexcept;
    /// Returns a lower bound of either interpolant within `radius` of `position`, used to cull whole groups of points.
    /// Outside the grid the bound is the distance to the grid.
    double min_within(const Vec3& position, double radius) const noexcept;
};

/// Makes a voxmap of an unchanged distance grid. Throws Error for fewer than 2 samples along an axis, spacings that are
/// not positive, more than 2³⁰ samples and values that are not finite. The result does not depend on how jobs are run.
Voxmap make_voxmap(volume::Grid distance, const RunJobs& run = run_in_turn);

/// Makes a voxmap of one version of a bone: exact near its surface, `far` where it stores no bricks.
Voxmap make_voxmap(const volume::BoneSnapshot& bone);

/// Samples a distance function `distance(Vec3) -> m` at the samples of `layout` (its values are not read).
template <class Distance>
Voxmap sample_voxmap(volume::Grid layout, const Distance& distance) {
    layout.values.resize(layout.count());
    for (int k = 0; k < layout.size[2]; ++k)
        for (int j = 0; j < layout.size[1]; ++j)
            for (int i = 0; i < layout.size[0]; ++i)
                layout.at(i, j, k) = static_cast<float>(distance(layout.position(i, j, k)));
    return make_voxmap(std::move(layout));
}

/// The distance used in the thesis, for comparison: a 3-4-5 chamfer distance (Borgefors 1986; 3 along an axis, 4 and 5
/// along the diagonals of faces and cells), divided by 3 and measured from the middle between inside and outside
/// samples. Uses the signs of `distance` only. Needs cubic cells (within 0.1 %); throws Error otherwise.
volume::Grid chamfer_distance(const volume::Grid& distance);

}  // namespace tactus::contact

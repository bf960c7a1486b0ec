// SPDX-License-Identifier: Apache-2.0
// A bone as a guide meets it that is put on and taken off along one direction.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <vector>

namespace tactus::cutting_guide {

/// Distance from the space that a guide may not occupy: the bone and what lies in its shadow along -z, so that a guide
/// outside of it can be lifted along +z. A grid holds the smallest distance to the bone of a sample and all those above
/// it; samples below the highest surface of their column are negative. So undercuts are relieved, marrow cavities and
/// meshes that are open or wound the wrong way do not matter. m, in a frame whose z is the direction of removal.
class SeatedBone {
public:
    /// `bone` in that frame; the grid covers `low` to `high` with this spacing. Distances beyond `cap` are not computed.
    SeatedBone(const geometry::TriangleSurface& bone, const geometry::TriangleTree& tree, const Vec3& low,
               const Vec3& high, double spacing, double cap, const RunJobs& run);

    /// At most `cap`; trilinear, so that it changes by at most the distance between two positions (times 1.8 in cells that
    /// the edge of the shadow crosses).
    double value(const Vec3& p) const noexcept;
    /// Unit; the direction of removal where the distance does not change.
    Vec3 gradient(const Vec3& p) const noexcept;
    /// z of the highest surface in the column of (x, y); none within the grid: -infinity.
    double top(double x, double y) const noexcept;
    /// The highest of `top` in a box of x and y; -infinity: no bone.
    double top_within(const Vec3& low, const Vec3& high) const noexcept;

private:
    void raise(const geometry::TriangleSurface& bone);
    std::size_t column(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.size[0]) + static_cast<std::size_t>(i);
    }

    volume::Grid grid_;
    std::vector<double> top_;  // per column
};

}  // namespace tactus::cutting_guide

// SPDX-License-Identifier: Apache-2.0
// A bone as a guide meets it that is put on and taken off along one direction.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace tactus::cutting_guide {

/// Distances sampled on a grid of cubic cells, trilinear in between.
struct DistanceField {
    volume::Grid grid;

    double value(const Vec3& p) const noexcept;  ///< m; beyond the grid that of its border
    /// Unit; +z where the distance does not change.
    Vec3 gradient(const Vec3& p) const noexcept;
};

/// A part of a surface: the distance from it, and its box.
struct Patch {
    DistanceField distance;
    Vec3 low{0.0}, high{0.0};
};

/// Distance from the space that a guide may not occupy: the bone and what lies in its shadow along -z, so that a guide
/// outside of it can be lifted along +z. A grid holds the smallest distance to the bone of a sample and all those above
/// it; samples below the highest surface of their column are negative. So undercuts are relieved, marrow cavities and
/// meshes that are open or wound the wrong way do not matter. m, in a frame whose z is the direction of removal.
class SeatedBone {
public:
    /// `bone` in that frame; the grid covers `low` to `high` with samples at multiples of this spacing, so
    /// that it is the same bone in any such box. Distances beyond `cap` are not computed.
    SeatedBone(const geometry::TriangleSurface& bone, const geometry::TriangleTree& tree, const Vec3& low,
               const Vec3& high, double spacing, double cap, const RunJobs& run);

    /// At most `cap`; trilinear, so that it changes by at most the distance between two positions (times 1.8 in cells that
    /// the edge of the shadow crosses).
    double value(const Vec3& p) const noexcept { return field_.value(p); }
    /// Unit; the direction of removal where the distance does not change.
    Vec3 gradient(const Vec3& p) const noexcept { return field_.gradient(p); }
    /// Of the surface of that space, of what `belongs`, the connected part nearest to `at`. What is near a patch ends with a round edge beside it, at any shape of bone. Without such a part, `cap` everywhere and a box at `at`.
    Patch patch_of(const std::function<bool(const Vec3& p, const Vec3& normal)>& belongs, const Vec3& at,
                   const RunJobs& run) const;
    /// Distance from other triangles in the same frame, at most `cap`, at the same samples.
    std::shared_ptr<const Patch> distance_from(const geometry::TriangleTree& tree, double cap,
                                               const RunJobs& run) const;
    /// z of the highest surface in the column of (x, y); none within the grid: -infinity.
    double top(double x, double y) const noexcept;
    /// The highest of `top` in a box of x and y; -infinity: no bone.
    double top_within(const Vec3& low, const Vec3& high) const noexcept;

private:
    void raise(const geometry::TriangleSurface& bone);
    std::size_t column(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(field_.grid.size[0]) +
               static_cast<std::size_t>(i);
    }

    DistanceField field_;
    double cap_;
    std::vector<double> top_;  // per column
};

}  // namespace tactus::cutting_guide

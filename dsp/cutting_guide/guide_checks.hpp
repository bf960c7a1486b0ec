// SPDX-License-Identifier: Apache-2.0
// Measures of a guide from its mesh alone, independent of how it was made.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/cutting_guide/guide.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/geometry/triangle_tree.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace tactus::cutting_guide {

/// Thicker walls are not measured, m.
inline constexpr double max_measured_wall = 6e-3;
/// A wall is measured by this many triangles at least: single ones are folds of the mesh at its corners.
inline constexpr std::size_t wall_triangles = 6;

/// Walls of a closed surface.
struct Walls {
    std::optional<ThinWall> thinnest;  ///< none: no wall is thinner than max_measured_wall
    Tapers tapers;
    std::vector<ThinWall> thin;  ///< one per triangle whose wall is thinner than `limit`, in the order of the triangles
    std::vector<Vec3> balls;  ///< middles of balls as wide as `limit` within the solid; empty without thin walls

    bool is_thin() const { return thin.size() >= wall_triangles; }
};

/// The thickness of a wall at a triangle is twice the radius of the smallest ball within the solid that touches the
/// middle of the triangle and another place whose normal differs by at least 150°: a ball at a corner touches faces
/// that differ less. The balls shrink from a bound (Ma, Bae, Choi 2012): first at every 32nd triangle from
/// max_measured_wall, then at all of them from the thinnest wall of these, at least `limit`. A single pass so gives the
/// thinnest wall and all thin ones, while most balls need one query.
///
/// Where a wall ends with a round edge, balls become smaller towards the edge until the faces differ by 150°. This is
/// no thin wall: a ball whose middle lies within a ball as wide as `limit` does not count. So a wall that ends as a
/// wedge of `angle` may be missed as far as its end is thinner by less than limit sin(angle / 2): by 0.1 mm at 6°.
///
/// The ball at the end of a wedge touches the end, too, so that it is wider than the end is thick: a wedge of `angle`
/// whose balls are as wide as `limit` ends no thinner than limit tan(45° - angle / 4), 0.77 of it at 30°. `tapers` has
/// the ends themselves: where a ball is narrower than `limit` but touches no opposite face, lines across the solid find
/// the face on the other side, and the chord at equal angles to both faces is the thickness.
/// Triangles for which `counts` is false are not measured. `tree` is of `surface`. m.
Walls walls_of(const geometry::TriangleSurface& surface, const geometry::TriangleTree& tree, double limit,
               const std::function<bool(const Vec3&)>& counts, const RunJobs& run);

/// How a guide lies on its bone.
struct Seat {
    double contact_area = 0.0;  ///< m²: of the faces that look at the bone, at `offset` ± 0.1 mm from it
    double relieved_area = 0.0;  ///< m²: of those that are farther, up to 4 mm: undercuts of the approach
    double min_distance = 0.0;  ///< m, from the bone; infinite: no part is nearer than 4 mm; never negative
    bool is_path_free = true;  ///< no part meets bone on `free_path` along the removal, nor on the way back
    Vec3 blocked_at{0.0};  ///< where it does, on the guide
    double play = 0.0;  ///< m, of its middle, in the direction in which the bone holds it least
    Vec3 play_direction{0.0};  ///< unit
    double play_angle = 0.0;  ///< rad, about the axis about which the bone holds it least
    double contact_share() const { return contact_area > 0.0 ? contact_area / (contact_area + relieved_area) : 0.0; }
};

/// Most that `Seat::play` and `Seat::play_angle` are: beyond, linear play means nothing, and the bone does not hold.
inline constexpr double max_play = 20e-3, max_play_angle = 0.5;  // m, rad

/// Play: all motions for which contact faces move by no more than `gap` along their normals (root of the mean square, so
/// it is more than with the strictest reading), linearised at the seat; a shaft that a guide slides along gives
/// max_play. m.
Seat seat_of(const geometry::TriangleSurface& guide, const geometry::TriangleTree& bone, const Vec3& removal,
             double offset, double gap, double free_path, const RunJobs& run);

/// The walls of a slot as they are in the mesh.
struct SlotFit {
    double offset = 0.0;  ///< m, of the wall on the kept side from the plan, out of the bone that is kept
    double angle = 0.0;  ///< rad, between them
    double width = 0.0;  ///< m, between the walls; 0 without a second one
    double kept_area = 0.0, other_area = 0.0;  ///< m², of the wall on the kept side, and of the one opposite
};

/// Planes through the middles of the triangles of each wall, by least squares with their areas; infinite offset and angle
/// when the wall on the kept side is missing.
SlotFit refit_slot(const geometry::TriangleSurface& surface, const MadeSlot& slot);

/// m of solid between a hole and the next face beside it, in the thinnest of 24 directions at MadeHole::middle, at most
/// max_measured_wall; 0 if the hole is open to a side there. `tree` is of the guide's surface, in the frame of `hole`.
double hole_wall(const geometry::TriangleTree& tree, const MadeHole& hole);

/// Share of the area whose normal looks more than `angle` below the horizon when the guide is printed along `up`; the
/// lowest 0.3 mm lie on the plate and do not count.
double overhang_share(const geometry::TriangleSurface& surface, const Vec3& up, double angle);

}  // namespace tactus::cutting_guide

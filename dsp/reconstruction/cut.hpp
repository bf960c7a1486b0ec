// SPDX-License-Identifier: Apache-2.0
// Cuts a bone's surface by bounded planes.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/section.hpp"

#include <optional>
#include <vector>

namespace tactus::reconstruction {

/// The plane, or both planes, that cut a piece.
enum class CutBy { none, first, last, both };

struct RestPiece {
    geometry::TriangleSurface surface;
    CutBy cut_by = CutBy::none;  ///< none: a separate body, such as a tooth
};

struct CutPieces {
    geometry::TriangleSurface between;  ///< the part between the planes
    std::vector<RestPiece> rest;        ///< the other pieces, the largest volume first
};

/// Largest distance of a plane's origin from the bone; farther away, the limb to cut is ambiguous.
inline constexpr double farthest_from_limb = 15e-3;  // m

/// Cuts a closed surface by two planes, `first` with its normal into the part between them and `last` with its normal
/// out of it; without `last`, everything connected on the far side of `first` is cut off. Each plane cuts only the limb
/// around its origin (section_of with `near`): a plane through one ramus of a jaw does not cut the other one. Cavities
/// stay with the piece that encloses them (bodies_of). Pieces of closed surfaces are closed: each outline gets a fan of
/// triangles around its centre. On an outline that is not star-shaped the fan overlaps itself, and on a marrow cavity
/// it overlaps the outer one; signed volumes and winding numbers remain correct. Throws Error if a plane misses the
/// surface, if its origin lies more than farthest_from_limb outside of it, if the planes intersect inside the surface,
/// and if they do not separate it.
CutPieces cut_between(const geometry::TriangleSurface& surface, const Plane& first, const std::optional<Plane>& last);

}  // namespace tactus::reconstruction

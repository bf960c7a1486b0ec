// SPDX-License-Identifier: Apache-2.0
// Cuts a bone's surface by bounded planes.
#pragma once

#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruct/section.hpp"

#include <optional>
#include <vector>

namespace tactus::reconstruct {

/// The plane, or both planes, that made faces of a piece.
enum class CutBy { none, first, last, both };

struct RestPiece {
    geometry::TriangleSurface surface;
    CutBy cut_by = CutBy::none;  ///< none: a separate body, such as a tooth
};

struct CutPieces {
    geometry::TriangleSurface between;  ///< what the planes bound
    std::vector<RestPiece> rest;        ///< the other pieces, the largest volume first
};

/// An origin that lies farther outside the bone does not tell which limb the plane cuts.
inline constexpr double farthest_from_limb = 15e-3;  // m

/// Cuts a closed surface by two planes, `first` with its normal into the piece between them and `last` with its normal
/// out of it; without `last`, all that is connected on the far side of `first` is cut off. Each plane cuts only the
/// limb round its origin (section_of with `near`): a plane through one ramus of a jaw leaves the other one whole.
/// Cavities stay with the piece that encloses them (bodies_of). Pieces of closed surfaces are closed: each outline gets a
/// fan of triangles around its middle. On an outline that is
/// not star-shaped the fan folds over itself, on a marrow cavity it overlaps the outer one; signed volumes and winding
/// numbers stay right. Throws Error when a plane misses the surface or its origin lies more than farthest_from_limb
/// outside of it, when the planes cross inside the surface, and when they do not separate it.
CutPieces cut_between(const geometry::TriangleSurface& surface, const Plane& first, const std::optional<Plane>& last);

}  // namespace tactus::reconstruct

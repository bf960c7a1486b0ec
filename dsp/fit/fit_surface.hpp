// SPDX-License-Identifier: Apache-2.0
// One side of a fit: the painted points of a body, and the distance field around them, which the points of the other
// side sample.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fit {

struct FitSurfaceOptions {
    std::uint8_t paint = contact::surface_label::fracture;  ///< label of the points to fit
    std::uint8_t other_paint =
        contact::surface_label::fracture;  ///< label of other faces: neither paint nor outer contour
    double reach = 12e-3;  ///< m: extent of the field around painted points; no attraction beyond it
    double outline = 6e-3;  ///< m: unpainted points closer to the paint than this form the outer contour
    std::size_t max_outline = 240;  ///< points of the outline, spread evenly
    double max_gap = 1.5e-3;  ///< m: painted points farther apart belong to different faces
    std::size_t max_samples = 8'000'000;  ///< of the field; it becomes coarser instead of larger
};

/// Positions are relative to `centre`, so that rotations are about the centroid of the paint.
struct FitSurface {
    Vec3 centre{0.0};  ///< centroid of the painted points, body frame, m
    std::vector<Vec3> position, normal;  ///< painted points, m, and unit normals out of the bone
    std::vector<double> share;  ///< fraction of the painted area; the sum is 1
    double area = 0.0;  ///< painted, m²
    Vec3 mean_normal{0.0};  ///< area-weighted mean of the paint; shorter than 1 where it is rough or curved
    /// Unit normal of the plane through the paint, out of the bone; a kerf opens along it. The mean normal of rough
    /// paint is not used, because it depends only on the rim, where it follows the relief. If the paint is not flat,
    /// this is the mean normal.
    Vec3 plane_normal{0.0};
    Vec3 far{0.0};  ///< the point of the whole body farthest from the centre
    double gyration = 0.0;  ///< root mean square distance of painted points from their centroid, m
    std::vector<Vec3> outline, outline_normal;  ///< unpainted points around the paint
    contact::Voxmap field;  ///< signed distance of the whole bone around the paint
    std::vector<std::uint8_t> painted;  ///< per sample of the field: the nearest surface point is painted

    /// Returns whether the surface point nearest to `place` (m, from the centre) is painted. False outside of the
    /// field.
    bool is_painted_near(const Vec3& place) const noexcept;
};

/// Makes a side from the points of a body's whole surface and its signed distance, both in the body's frame. Beyond the
/// distance grid the field continues as the distance to the nearest point. Throws Error for fewer than 30 painted
/// points, and when no sample of `distance` is near them.
FitSurface make_fit_surface(std::span<const contact::SurfacePoint> points, const volume::Grid& distance,
                            const FitSurfaceOptions& options = {});

/// The same for a pull that is evaluated every tick: with half of the outline's points, because the search for their
/// partners is expensive.
FitSurface make_live_fit_surface(std::span<const contact::SurfacePoint> points, const volume::Grid& distance);

/// One surface per connected patch of paint, largest first: a fragment from the middle of a bone has several. Omits
/// patches of fewer than 30 points; throws Error as above if none remains.
std::vector<FitSurface> make_fit_faces(std::span<const contact::SurfacePoint> points, const volume::Grid& distance,
                                       const FitSurfaceOptions& options = {});

/// Makes one face of several, from the indices of its points: points of other faces are neither its paint nor its
/// outline.
FitSurface make_fit_face(std::span<const contact::SurfacePoint> points, std::span<const std::size_t> face,
                         const volume::Grid& distance, const FitSurfaceOptions& options = {});

}  // namespace tactus::fit

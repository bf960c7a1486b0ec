// SPDX-License-Identifier: Apache-2.0
// One side of a fit: the painted points of a body, the bone around them, and what a point of the other side finds there.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fit {

struct FitSurfaceOptions {
    std::uint8_t paint = contact::surface_label::fracture;  ///< label of the points that are to fit
    std::uint8_t other_paint = contact::surface_label::fracture;  ///< of other faces: neither paint nor outer contour
    double reach = 12e-3;  ///< m: how far from painted points the field goes on: no pull from farther away
    double outline = 6e-3;  ///< m: points this near to the paint, not painted, show how the outer contour goes on
    std::size_t most_outline = 240;  ///< points of the outline, spread evenly
    double max_gap = 1.5e-3;  ///< m: painted points farther apart belong to different faces
    std::size_t most_samples = 8'000'000;  ///< of the field; it gets coarser rather than larger
};

/// Everything is measured from `centre`, so that turns are about the middle of the paint.
struct FitSurface {
    Vec3 centre{0.0};  ///< middle of the painted points, body frame, m
    std::vector<Vec3> position, normal;  ///< painted points, m, and unit normals out of the bone
    std::vector<double> share;  ///< of the painted area; they add up to 1
    double area = 0.0;  ///< painted, m²
    Vec3 mean_normal{0.0};  ///< of the paint, weighted by area; shorter than 1 where it is rough or bent
    double gyration = 0.0;  ///< root mean square distance of painted points from their middle, m
    std::vector<Vec3> outline, outline_normal;  ///< unpainted points around the paint
    contact::Voxmap field;  ///< signed distance of the whole bone about the paint
    std::vector<std::uint8_t> painted;  ///< per sample of the field: the nearest point of the surface is painted

    /// Whether the surface nearest to `place` (m, from the centre) is painted. False outside of the field.
    bool is_painted_near(const Vec3& place) const noexcept;
};

/// From the points of a body's whole surface and its signed distance, both in the body's frame. Where the distance grid
/// ends the field goes on as the distance to the nearest point. Throws Error without painted points, with less than 30
/// (nothing can be told from them), and when no sample of `distance` lies near them.
FitSurface make_fit_surface(std::span<const contact::SurfacePoint> points, const volume::Grid& distance,
                            const FitSurfaceOptions& options = {});

/// The same for a pull that is read every tick: with half of the outline's points, whose partners are searched one by one.
FitSurface make_live_fit_surface(std::span<const contact::SurfacePoint> points, const volume::Grid& distance);

/// One surface per patch of paint that hangs together, largest first: a fragment from the middle has several. Patches of
/// less than 30 points are left out; throws Error as above when none is left.
std::vector<FitSurface> make_fit_faces(std::span<const contact::SurfacePoint> points, const volume::Grid& distance,
                                       const FitSurfaceOptions& options = {});

/// One face of several, by the indices of its points: points of other faces are neither its paint nor its outline.
FitSurface make_fit_face(std::span<const contact::SurfacePoint> points, std::span<const std::size_t> face,
                         const volume::Grid& distance, const FitSurfaceOptions& options = {});

}  // namespace tactus::fit

// SPDX-License-Identifier: Apache-2.0
// Proposes the fracture surface of a fragment, for manual correction.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/fit/registration/registration.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::plan {

struct ProposalOptions {
    double near = 1.5e-3;      ///< m: radius for the roughness of a point
    double smooth = 3.0e-3;    ///< m: radius for the median over neighbours
    double roughness = 0.06;   ///< threshold of roughness (mean of 1 − cos of the angle between normals)
    double min_area = 20e-6;  ///< m², smaller patches are dropped
};

/// Labels rough patches: broken bone is rougher at the scale of 1 to 2 mm than natural bone surface, which curves over
/// centimetres. Teeth, sutures and sharp rims are rough as well. Removes other labels. Returns the number of labelled
/// points.
std::size_t propose_fracture(std::span<contact::SurfacePoint> points, const ProposalOptions& options = {});

struct FacingOptions {
    double reach = 10e-3;      ///< m: largest distance to the other fragment, as scanned
    double min_area = 20e-6;  ///< m², smaller patches are dropped
};

/// Labels the points that face points of another fragment at a small distance. This works because fragments in one scan
/// are not far from their original position, and natural surfaces rarely face each other that closely. For smooth or
/// coarse scans, in which roughness does not reveal the fracture. Removes other labels. Returns the number of labelled
/// points. Throws Error if `other` has no points.
std::size_t propose_facing(std::span<contact::SurfacePoint> points, std::span<const contact::SurfacePoint> other,
                           const FacingOptions& options = {});

struct IntactOptions {
    double deep = 2e-3;  ///< m: points deeper in the unbroken bone are broken
    double askew = 0.7e-3;  ///< m: points deeper than this are also broken if their normal differs from the bone's,
    double looks_along = 0.3;  ///< that is, if the cosine between the normals is below this
    double smooth = 3e-3;  ///< m: radius for the median over neighbours
    double min_area = 50e-6;  ///< m², smaller patches are dropped
};

/// Labels the points well inside the unbroken bone (the mirrored healthy side, or an earlier scan) registered to the
/// fragment; `place` maps the points into it. Independent of roughness and distance, but also labels differences
/// between the sides of the body. Removes other labels. Returns the number of labelled points.
std::size_t propose_inside(std::span<contact::SurfacePoint> points, const fit::RegistrationTarget& intact,
                           const Pose& place, const IntactOptions& options = {});

/// The same in two steps: a flag per point (1: broken), regardless of the smallest area, and the patches of these
/// points.
std::vector<std::uint8_t> broken_inside(std::span<const contact::SurfacePoint> points,
                                        const fit::RegistrationTarget& intact, const Pose& place,
                                        const IntactOptions& options = {});
std::size_t label_broken(std::span<contact::SurfacePoint> points, const std::vector<std::uint8_t>& broken,
                         double min_area);

/// Removes the label of patches without a point within `reach` (m) of the other fragment, as scanned. Returns the
/// number of points that keep their label. Throws Error if `other` has no points.
std::size_t keep_patches_near(std::span<contact::SurfacePoint> points, std::span<const contact::SurfacePoint> other,
                              double reach);

/// Removes the label of faces (see fit::split_faces) smaller than `min_area` (m²), and of labelled points that belong
/// to no face. With 0, does nothing. Returns the number of points that stay labelled.
std::size_t drop_small_faces(std::span<contact::SurfacePoint> points, double min_area);

}  // namespace tactus::plan

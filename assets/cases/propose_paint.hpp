// SPDX-License-Identifier: Apache-2.0
// A first guess of where a fragment is broken, to be corrected by hand.
#pragma once

#include "dsp/contact/pointshell.hpp"
#include "dsp/fit/registration.hpp"

#include <cstddef>
#include <span>

namespace tactus::cases {

struct ProposalOptions {
    double near = 1.5e-3;      ///< m: how far the roughness of a place is looked at
    double smooth = 3.0e-3;    ///< m: neighbours this far away vote on it
    double roughness = 0.06;   ///< mean of 1 − cos of the angle between normals nearby, above which it is broken
    double least_area = 20e-6;  ///< m², smaller patches are left out
};

/// Labels the points of rough patches: broken bone is rougher within a millimetre or two than grown bone, which bends
/// over centimetres. Teeth, sutures and sharp rims are rough as well. Other labels are taken off. Returns how many
/// points are labelled.
std::size_t propose_fracture(std::span<contact::SurfacePoint> points, const ProposalOptions& options = {});

struct FacingOptions {
    double reach = 10e-3;      ///< m: how far the other fragment may be, as they lie in the scan
    double least_area = 20e-6;  ///< m², smaller patches are left out
};

/// Labels the points that look at another fragment which looks back at them: fragments of one scan were not moved far, and
/// grown bone rarely faces grown bone so near. For smooth or coarse scans, where broken bone is no rougher than the rest.
/// Other labels are taken off. Returns how many points are labelled. Throws Error when `other` has no points.
std::size_t propose_facing(std::span<contact::SurfacePoint> points, std::span<const contact::SurfacePoint> other,
                           const FacingOptions& options = {});

struct IntactOptions {
    double deep = 2e-3;  ///< m: what lies deeper in the unbroken bone is broken
    double askew = 0.7e-3;  ///< m: and what lies deeper than this and does not look the way its surface does,
    double looks_along = 0.3;  ///< by the cosine between their normals
    double smooth = 3e-3;  ///< m: neighbours this far away vote on it
    double least_area = 50e-6;  ///< m², smaller patches are left out
};

/// Labels the points that lie well within the unbroken bone: the healthy side mirrored, or an earlier scan, laid where
/// the fragment belongs. `place` takes the points there. Finds broken bone however smooth it is and wherever it lies,
/// and what differs between the sides of a body as well. Other labels are taken off. Returns how many points are
/// labelled.
std::size_t propose_inside(std::span<contact::SurfacePoint> points, const fit::RegistrationTarget& intact,
                           const Pose& place, const IntactOptions& options = {});

/// Takes the label off patches that nowhere come within `reach` (m) of the other fragment's points, as they lie in the
/// scan. Returns how many points stay labelled. Throws Error when `other` has no points.
std::size_t keep_patches_near(std::span<contact::SurfacePoint> points, std::span<const contact::SurfacePoint> other,
                              double reach);

}  // namespace tactus::cases

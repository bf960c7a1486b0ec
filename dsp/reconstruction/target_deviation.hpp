// SPDX-License-Identifier: Apache-2.0
// How far the segments of a reconstruction depart from a target: the mirrored healthy side, or the jaw of another person.
#pragma once

#include "dsp/fit/registration/registration.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace tactus::reconstruction {

/// The target in the frame of the jaw.
struct DeviationTarget {
    geometry::TriangleSurface surface;
    fit::RegistrationTarget points;  ///< of its outside

    /// Uses the vertices of `from` with their normals. Throws Error without triangles.
    explicit DeviationTarget(geometry::TriangleSurface from);
};

struct SegmentDeviation {
    /// Of the segment's axis from the middle of the target within 15 mm, in sections across the axis that are at most 2 mm
    /// apart; m.
    struct Curve {
        double rms = 0.0, greatest = 0.0;
    };
    /// Of the segment's outer surface from the target's, where both face the same way (within 60°); m, positive beyond the
    /// target. Shares by area.
    struct Contour {
        double rms = 0.0;
        double lowest = 0.0, highest = 0.0;  ///< 2.5 and 97.5 %
        double share = 0.0;  ///< of the segment's outer surface, that faces the target
    };
    std::optional<Curve> curve;  ///< none if the target does not reach along half of the segment
    std::optional<Contour> contour;  ///< none if nothing faces the target within 15 mm
};

/// One per segment of `plan`, whose poses are those where the segments lie. A fibula is thinner than a jaw, so that part of
/// its contour lies within the target even where the curve is met. `inputs` needs the donor's surface.
std::vector<SegmentDeviation> deviation_of(const FibulaInputs& inputs, const FibulaPlan& plan,
                                           const DeviationTarget& target);

}  // namespace tactus::reconstruction

// SPDX-License-Identifier: Apache-2.0
// Which parts of a vessel stay on the kept pieces of a donor, and which hang free.
#pragma once

#include "dsp/reconstruct/clearance.hpp"
#include "dsp/reconstruct/fibula_plan.hpp"
#include "dsp/reconstruct/flap.hpp"

#include <cstddef>
#include <vector>

namespace tactus::reconstruct {

/// Parts of a vessel from its end at the knee, where it is cut to be joined, to the ankle.
struct VesselPart {
    enum class Kind {
        pedicle,   ///< stripped off the discarded bone at the knee: free at one end
        attached,  ///< rides along with a segment
        span,      ///< between two segments, stripped off the wedge
        lost       ///< beyond the last segment: ligated
    };
    Kind kind = Kind::pedicle;
    std::size_t segment = 0;  ///< attached: on which; pedicle: from which it leaves; span: the one at its knee's end
    std::vector<Vec3> points;  ///< m, frame of the donor
    double length = 0.0;       ///< m, in the leg
};

/// A part is on a segment where it lies between the two planes that cut the segment: they cut the vessel's surroundings
/// as well (as in BoneReconstructionPlanner). Which end is at the knee, the line tells.
std::vector<VesselPart> parts_of(const FlapVessel& vessel, const FibulaInputs& inputs, const FibulaPlan& plan);

/// The segment whose planes enclose a point of the donor, or the number of segments.
std::size_t segment_at(const FibulaPlan& plan, const Vec3& at);

/// m between a point of the donor and the nearest cut of the kept segments.
double distance_to_cuts(const FibulaPlan& plan, const Vec3& at);

/// Attached parts and spans (straight) in the frame of the jaw, without the pedicle.
PlacedVessel placed(const FlapVessel& vessel, const std::vector<VesselPart>& parts, const FibulaPlan& plan);

}  // namespace tactus::reconstruct

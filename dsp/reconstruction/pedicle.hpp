// SPDX-License-Identifier: Apache-2.0
// Splits a vessel into parts that stay on the kept segments of a donor and parts that hang free.
#pragma once

#include "dsp/reconstruction/clearance.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"

#include <cstddef>
#include <vector>

namespace tactus::reconstruction {

/// A part of a vessel, from its end at the knee, where it is cut to be joined, to the ankle.
struct VesselPart {
    enum class Kind {
        pedicle,   ///< stripped off the discarded bone at the knee: one free end
        attached,  ///< moves with a segment
        span,      ///< between two segments, stripped off the wedge
        lost       ///< beyond the last segment: ligated
    };
    Kind kind = Kind::pedicle;
    std::size_t segment = 0;  ///< attached: its own; pedicle: the one that it leaves; span: the one at the knee end
    std::vector<Vec3> points;  ///< m, frame of the donor
    double length = 0.0;       ///< m, in the leg
};

/// A part is attached to a segment if it lies between the segment's two cutting planes, which also cut the vessel's
/// surroundings (as in BoneReconstructionPlanner). The line determines which end is at the knee.
std::vector<VesselPart> parts_of(const FlapVessel& vessel, const FibulaInputs& inputs, const FibulaPlan& plan);

/// Returns the segment whose planes enclose a point of the donor, or the number of segments if there is none.
std::size_t segment_at(const FibulaPlan& plan, const Vec3& at);

/// Returns the distance in m from a point of the donor to the nearest cut of the kept segments.
double distance_to_cuts(const FibulaPlan& plan, const Vec3& at);

/// Returns attached parts and (straight) spans in the frame of the jaw, without the pedicle.
PlacedVessel placed(const FlapVessel& vessel, const std::vector<VesselPart>& parts, const FibulaPlan& plan);

}  // namespace tactus::reconstruction

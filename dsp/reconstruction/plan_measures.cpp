// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/plan_measures.hpp"

#include "dsp/reconstruction/plan_frame.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cstddef>

namespace tactus::reconstruction {

namespace {

Section mapped(Section section, const Pose& pose) {
    for (Vec3& p : section.points) p = pose.apply(p);
    return section;
}

}  // namespace

void measure_faces(FibulaPlan& plan, const FibulaInputs& inputs, const Cuts& cuts) {
    plan.contact.resize(plan.segments.size() - 1);
    if (cuts.empty()) return;
    plan.kerf_loss = 0.0;
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        FibulaSegment& s = plan.segments[n];
        for (std::size_t end = 0; end < 2; ++end) {
            s.area[end] = overlap_area(cuts[n][end], cuts[n][end], s.donor_plane[end]);
            *plan.kerf_loss += *s.area[end] * inputs.kerf;
            double farthest = 0.0;
            for (const Vec3& p : cuts[n][end].points)
                farthest = std::max(farthest, glm::length(p - s.donor_plane[end].origin));
            s.farthest[end] = farthest;
        }
        if (n + 1 == plan.segments.size()) continue;
        const FibulaSegment& after = plan.segments[n + 1];
        const Plane joint{s.donor_to_target.apply(s.donor_plane[1].origin),
                          s.donor_to_target.rotate(s.donor_plane[1].normal)};
        plan.contact[n] =
            overlap_area(mapped(cuts[n][1], s.donor_to_target), mapped(cuts[n + 1][0], after.donor_to_target), joint);
    }
}

void measure_joints(FibulaPlan& plan, const std::vector<double>& off_bisector, const DonorBone& donor) {
    plan.off_bisector = off_bisector;
    for (std::size_t n = 0; n + 1 < plan.segments.size(); ++n) {
        const FibulaSegment &before = plan.segments[n], &after = plan.segments[n + 1];
        plan.wedges.push_back(angle_between(before.donor_plane[1].normal, after.donor_plane[0].normal));
        // What remains of the turn from one segment to the next when their axes are brought together by the least turn.
        const Vec3 from = before.donor_to_target.rotate(donor.axis()), to = after.donor_to_target.rotate(donor.axis());
        const Vec3 side = glm::cross(from, to);
        const double angle = angle_between(from, to);
        const Vec3 carried = before.donor_to_target.rotate(donor.frame()[0]);
        const Vec3 brought = glm::length(side) > 1e-9 ? glm::angleAxis(angle, glm::normalize(side)) * carried : carried;
        plan.rolls.push_back(angle_between(brought, after.donor_to_target.rotate(donor.frame()[0])));
    }
}

}  // namespace tactus::reconstruction

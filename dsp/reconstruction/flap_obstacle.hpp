// SPDX-License-Identifier: Apache-2.0
// The obstacle for a flap's vessels: the bone of the jaw, and the donor segments at their planned poses.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/rope/obstacle.hpp"

#include <span>
#include <vector>

namespace tactus::reconstruction {

/// The fields that it uses must outlive it.
class FlapObstacle final : public rope::Obstacle {
public:
    /// `jaw`: the remaining parts, in the frame of the jaw; `donor`: the whole bone in its frame, or null;
    /// `is_mirrored`: the plan is for the other leg, with the donor reflected at x = 0.
    FlapObstacle(const FibulaPlan& plan, std::span<const rope::Obstacle* const> jaw, const rope::Obstacle* donor,
                 bool is_mirrored = false);

    double distance(const Vec3& place, Vec3& normal) const noexcept override;
    double free_way(const Vec3& place, double now, double near) const noexcept override;

private:
    struct Segment {
        Pose to_jaw, to_donor;
        Plane low, high;
    };
    /// Lower bound of the distance to a segment, from its two cuts alone; `normal` in the frame of the donor.
    static double beyond_cuts(const Segment& segment, const Vec3& at, Vec3& normal) noexcept;
    double donor_distance(const Vec3& at, Vec3& normal) const noexcept;

    std::vector<const rope::Obstacle*> jaw_;
    const rope::Obstacle* donor_;
    bool is_mirrored_;
    std::vector<Segment> segments_;
};

}  // namespace tactus::reconstruction

// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/flap_obstacle.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::reconstruction {

namespace {

constexpr double far_away = 1.0;  // m

Vec3 mirrored(const Vec3& v) { return {-v.x, v.y, v.z}; }

}  // namespace

FlapObstacle::FlapObstacle(const FibulaPlan& plan, std::span<const rope::Obstacle* const> jaw,
                           const rope::Obstacle* donor, bool is_mirrored)
    : jaw_(jaw.begin(), jaw.end()), donor_(donor), is_mirrored_(is_mirrored) {
    if (!donor_) return;
    for (const FibulaSegment& s : plan.segments) {
        const bool is_reversed = s.along_line[0] > s.along_line[1];
        segments_.push_back({s.donor_to_target, s.donor_to_target.inverse(), s.donor_plane[is_reversed ? 1 : 0],
                             s.donor_plane[is_reversed ? 0 : 1]});
    }
}

double FlapObstacle::beyond_cuts(const Segment& segment, const Vec3& at, Vec3& normal) noexcept {
    const double below = glm::dot(segment.low.normal, segment.low.origin - at),
                 above = glm::dot(segment.high.normal, at - segment.high.origin);
    normal = below > above ? -segment.low.normal : segment.high.normal;
    return std::max(below, above);
}

double FlapObstacle::donor_distance(const Vec3& at, Vec3& normal) const noexcept {
    const double away = donor_->distance(is_mirrored_ ? mirrored(at) : at, normal);
    if (is_mirrored_) normal = mirrored(normal);
    return away;
}

double FlapObstacle::distance(const Vec3& place, Vec3& normal) const noexcept {
    double least = far_away;
    normal = Vec3(0.0);
    for (const rope::Obstacle* bone : jaw_) {
        Vec3 out(0.0);
        if (const double away = bone->distance(place, out); away < least) least = away, normal = out;
    }
    for (const Segment& segment : segments_) {
        const Vec3 at = segment.to_donor.apply(place);
        Vec3 cut_normal(0.0), out(0.0);
        const double beyond = beyond_cuts(segment, at, cut_normal);
        if (beyond >= least) continue;
        double away = donor_distance(at, out);
        if (beyond > away) away = beyond, out = cut_normal;
        if (away < least) least = away, normal = segment.to_jaw.rotate(out);
    }
    return least;
}

double FlapObstacle::free_way(const Vec3& place, double /*now*/, double near) const noexcept {
    double least = far_away;
    Vec3 ignored(0.0);
    for (const rope::Obstacle* bone : jaw_)
        least = std::min(least, bone->free_way(place, bone->distance(place, ignored), near));
    for (const Segment& segment : segments_) {
        const Vec3 at = segment.to_donor.apply(place);
        const double by_cuts = beyond_cuts(segment, at, ignored) - near;
        if (by_cuts >= least) continue;
        const Vec3 in_file = is_mirrored_ ? mirrored(at) : at;
        least = std::min(least, std::max(by_cuts, donor_->free_way(in_file, donor_->distance(in_file, ignored), near)));
    }
    return least;
}

}  // namespace tactus::reconstruction

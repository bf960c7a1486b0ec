// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/overlap.hpp"

#include <algorithm>

namespace tactus::fit {

namespace {

constexpr double most_deep_area = 10e-6;  // m²: as much of a surface may lie deep in another bone

double voxel_of(const PlacedBone& bone) noexcept {
    const Vec3& spacing = bone.map->grid.spacing;
    return std::max({spacing.x, spacing.y, spacing.z});
}

/// Whether that much of the points' surface is deeper than `depth` in the other bone.
bool lies_in(const PlacedBone& bone, const PlacedBone& other, double depth) noexcept {
    const Pose into = other.map_pose.inverse() * bone.points_pose;
    double area = 0.0;
    for (const contact::SurfacePoint& p : bone.points) {
        const volume::Sample here = other.map->sample(into.apply(p.position));
        if (here.inside && here.value < -depth && (area += p.area) > most_deep_area) return true;
    }
    return false;
}

}  // namespace

bool lie_in_each_other(const PlacedBone& a, const PlacedBone& b, double depth) noexcept {
    const double deep = std::max({depth, voxel_of(a), voxel_of(b)});
    return lies_in(a, b, deep) || lies_in(b, a, deep);
}

}  // namespace tactus::fit

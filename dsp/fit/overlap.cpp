// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/overlap.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::fit {

namespace {

constexpr double max_deep_area = 10e-6;  // m²: as much of a surface may lie deep in another bone

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
        if (here.inside && here.value < -depth && (area += p.area) > max_deep_area) return true;
    }
    return false;
}

/// Whether nearly all of the points' surface is within `voxel` of the other's.
bool lies_on(const PlacedBone& bone, const PlacedBone& other, double voxel) noexcept {
    const Pose into = other.map_pose.inverse() * bone.points_pose;
    double area = 0.0, on = 0.0;
    for (const contact::SurfacePoint& p : bone.points) {
        const volume::Sample here = other.map->sample(into.apply(p.position));
        area += p.area;
        if (here.inside && std::abs(here.value) < voxel) on += p.area;
    }
    return on > 0.9 * area;
}

}  // namespace

bool lie_in_each_other(const PlacedBone& a, const PlacedBone& b, double depth) noexcept {
    const double deep = std::max({depth, voxel_of(a), voxel_of(b)});
    return lies_in(a, b, deep) || lies_in(b, a, deep);
}

bool are_one_bone(const PlacedBone& a, const PlacedBone& b) noexcept {
    const double voxel = std::max(voxel_of(a), voxel_of(b));
    return lies_on(a, b, voxel) && lies_on(b, a, voxel);
}

}  // namespace tactus::fit

// SPDX-License-Identifier: Apache-2.0
// A bone's distance field as an obstacle.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/rope/obstacle.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>

namespace tactus::rope {

/// `pose` places the field; there may be several moving bodies. Outside of the field there is no bone.
class BoneField final : public Obstacle {
public:
    /// `field` must outlive this object.
    explicit BoneField(const contact::Voxmap& field, const Pose& pose = {}) : field_(field), pose_(pose) {}
    void move_to(const Pose& pose) noexcept { pose_ = pose; }

    double distance(const Vec3& place, Vec3& normal) const noexcept override {
        const volume::Sample at = field_.smooth_sample(pose_.inverse().apply(place));
        const double steep = glm::length(at.gradient);
        normal = steep > 1e-6 ? pose_.rotate(at.gradient / steep) : Vec3(0.0);
        return steep > 1e-6 ? at.value / steep : at.value;
    }

    /// The distance is value / steepness of the interpolant, which is not an exact distance, and it jumps at the border
    /// of the field. The clearance is therefore bounded by two properties: within a ball the value is at least the
    /// field's own bound, and its gradient is at most √3 times the largest difference of neighbouring samples.
    double free_way(const Vec3& place, double /*now*/, double near) const noexcept override {
        const Vec3 at = pose_.inverse().apply(place);
        const double least = std::max(near, 0.0) * std::numbers::sqrt3 * field_.steepness;
        for (const double way : {2e-3, 0.5e-3})
            if (field_.min_within(at, way) > least) return way;
        return 0.0;
    }

private:
    const contact::Voxmap& field_;
    Pose pose_;
};

}  // namespace tactus::rope

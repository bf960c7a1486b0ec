// SPDX-License-Identifier: Apache-2.0
// A bone's distance field as an obstacle.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/rope/obstacle.hpp"

#include <glm/geometric.hpp>

namespace tactus::rope {

/// Several bodies may move: `pose` places the field. Where the field ends there is no bone.
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

private:
    const contact::Voxmap& field_;
    Pose pose_;
};

}  // namespace tactus::rope

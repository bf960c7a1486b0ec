// SPDX-License-Identifier: Apache-2.0
// What a run says of a tool that cut bone, or that did not reach it.
#pragma once

#include "dsp/volume/bricks.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <vector>

namespace tactus::nodes {

class ToolReport {
public:
    /// One tick: `force` N and `lag` m count while the tool touches. `reach`: m from the pose to the tool's edge.
    void add(const volume::BoneSnapshot& bone, const Pose& pose, bool touches, double force, double lag,
             double reach) noexcept {
        ++ticks_;
        if (touches) {
            ++touching_;
            force_ += force;
            deepest_ = std::max(deepest_, lag);
        } else if (touching_ == 0.0 && is_valid(pose)) {
            at_ = pose.position;
            clearance_ = bone.value(at_) - reach;
        }
    }

    void tell(Report& report) const {
        const auto share = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
        report.set("contact", "fraction", share(touching_, ticks_));
        report.set("contact", "max_penetration_mm", deepest_ * 1e3);
        report.set("force", "thrust_mean_N", share(force_, touching_));
        if (touching_ > 0.0 || ticks_ == 0.0) return;
        report.set("contact", "blade_mm", std::vector<double>{at_.x * 1e3, at_.y * 1e3, at_.z * 1e3});
        report.set("contact", "blade_clearance_mm", clearance_ * 1e3);
    }

private:
    double ticks_ = 0.0, touching_ = 0.0, force_ = 0.0, deepest_ = 0.0, clearance_ = 0.0;
    Vec3 at_{0.0, 0.0, 0.0};
};

}  // namespace tactus::nodes

// SPDX-License-Identifier: Apache-2.0
// Summary of a tool that cuts bone: contact time, thrust and penetration, or the distance to the bone if it never touched.
#pragma once

#include "dsp/saw/tool_hold.hpp"
#include "dsp/volume/bricks.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <vector>

namespace tactus::nodes {

class ToolReport {
public:
    /// State of a tool in one tick.
    struct Now {
        saw::HoldState state = saw::HoldState::engaged;
        bool touches = false;
        double force = 0.0, lag = 0.0;  ///< N, m: counted while the tool touches; `force` as rendered
        double rendered = 1.0;  ///< fraction of the force that the device rendered
        double reach = 0.0;  ///< m from the pose to the tool's edge
        double seconds = 0.0;  ///< since the tick before, at most 50 ms
    };

    void add(const volume::BoneSnapshot& bone, const Pose& pose, const Now& now) noexcept {
        ++ticks_;
        releases_ += now.state == saw::HoldState::releasing && last_ != saw::HoldState::releasing;
        last_ = now.state;
        if (now.state == saw::HoldState::waiting && is_valid(pose)) waited_ += now.seconds;
        if (now.touches) {
            ++touching_;
            touched_ += now.seconds;
            force_ += now.force * now.rendered;
            deepest_ = std::max(deepest_, now.lag);
            limited_ += now.rendered < 0.99;
        } else if (touching_ == 0.0 && is_valid(pose)) {
            at_ = pose.position;
            clearance_ = bone.value(at_) - now.reach;
        }
    }

    /// `scale`: force on the device divided by force on the tool.
    void tell(Report& report, double scale) const {
        const auto share = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
        report.set("contact", "fraction", share(touching_, ticks_));
        report.set("contact", "seconds", touched_);
        report.set("contact", "max_penetration_mm", deepest_ * 1e3);
        report.set("contact", "limited_fraction", share(limited_, touching_));
        report.set("contact", "waited_s", waited_);
        report.set("contact", "releases", releases_);
        report.set("force", "thrust_mean_N", share(force_, touching_));
        report.set("force", "device_scale", scale);
        if (touching_ > 0.0 || ticks_ == 0.0) return;
        report.set("contact", "blade_mm", std::vector<double>{at_.x * 1e3, at_.y * 1e3, at_.z * 1e3});
        report.set("contact", "blade_clearance_mm", clearance_ * 1e3);
    }

private:
    double ticks_ = 0.0, touching_ = 0.0, force_ = 0.0, deepest_ = 0.0, clearance_ = 0.0;
    double touched_ = 0.0, limited_ = 0.0, waited_ = 0.0, releases_ = 0.0;
    saw::HoldState last_ = saw::HoldState::waiting;
    Vec3 at_{0.0, 0.0, 0.0};
};

}  // namespace tactus::nodes

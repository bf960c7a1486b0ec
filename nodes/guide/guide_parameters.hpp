// SPDX-License-Identifier: Apache-2.0
// Code common to all guides: law, position of the hand in the guide's frame, outputs.
#pragma once

#include "dsp/guide/guide_law.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <cmath>

namespace tactus::nodes {

/// Last part of the description of each guide.
#define TACTUS_GUIDE_ABOUT                                                                                           \
    " Conservative spring, damper, and both within 'max_force': passive but for sampling, which gives at most half " \
    "of "                                                                                                            \
    "stiffness times squared step per tick. A damping above stiffness × (half a period + delay) takes that again "   \
    "where "                                                                                                         \
    "the velocity is known in time; the energy cap of device_output does so always."

struct GuideParameters {
    Param stiffness{"0.5 N/mm", "0 N/mm", "20 N/mm", "force per distance"};
    Param damping{"1 N s/m", "0 N s/m", "50 N s/m", "force per velocity, where 'twist' is wired"};
    Param max_force{"3 N", "0 N", "50 N", "largest force of the guide"};
    TACTUS_GROUP(stiffness, damping, max_force)

    guide::GuideLaw law(double reach = 0.0) const noexcept { return {stiffness, damping, max_force, reach}; }
};

/// The hand in the frame of a guide.
struct GuidedHand {
    Vec3 position{0.0};  ///< m
    Vec3 velocity{0.0};  ///< m/s
    bool is_known = false;

    /// An invalid pose or frame gives no force; a velocity that is not finite gives no damping.
    GuidedHand(const In<Pose>& pose, const In<Twist>& twist, const In<Pose>& frame) noexcept {
        is_known = is_valid(pose.get()) && is_valid(frame.get());
        if (!is_known) return;
        position = frame->inverse().apply(pose->position);
        if (twist.connected && is_finite(twist->linear)) velocity = glm::conjugate(frame->orientation) * twist->linear;
        // Larger positions are ignored, so that squares stay finite.
        constexpr double far = 1e6;
        is_known = std::abs(position.x) < far && std::abs(position.y) < far && std::abs(position.z) < far;
        if (!(std::abs(velocity.x) < far && std::abs(velocity.y) < far && std::abs(velocity.z) < far))
            velocity = Vec3(0.0);
    }
};

/// Returns `v` normalised. Throws Error at the node if it has zero length.
inline Vec3 direction_of(const Setup& setup, const Vec3& v, const char* name) {
    const double length = std::hypot(v.x, v.y, v.z);
    if (!(length > 0.0) || !std::isfinite(length))
        setup.fail(std::string("'") + name + "' needs a length other than 0");
    return v / length;
}

/// The same for drawing; z if `v` has zero length.
inline Vec3 unit_of(const Vec3& v) noexcept {
    const double length = std::hypot(v.x, v.y, v.z);
    return length > 0.0 && std::isfinite(length) ? v / length : Vec3(0.0, 0.0, 1.0);
}

}  // namespace tactus::nodes

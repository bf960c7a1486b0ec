// SPDX-License-Identifier: Apache-2.0
// The plain values that travel on wires. SI units throughout.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace tactus {

using Vec3 = glm::dvec3;
using Mat3 = glm::dmat3;
using Quat = glm::dquat;  // constructor order w, x, y, z

/// Rigid placement: maps local coordinates to the surrounding frame, x ↦ position + orientation · x. Position in m,
/// orientation a unit quaternion.
struct Pose {
    Vec3 position{0.0, 0.0, 0.0};
    Quat orientation{1.0, 0.0, 0.0, 0.0};

    Vec3 apply(const Vec3& local) const { return position + orientation * local; }
    Vec3 rotate(const Vec3& direction) const { return orientation * direction; }
    Pose inverse() const {
        const Quat back = glm::conjugate(orientation);
        return {back * -position, back};
    }
    /// this ∘ other: `other` is given in this pose's local frame.
    Pose operator*(const Pose& other) const { return {apply(other.position), orientation * other.orientation}; }
};

/// Velocity of a pose: linear in m/s, angular in rad/s, both along world axes.
struct Twist {
    Vec3 linear{0.0, 0.0, 0.0};
    Vec3 angular{0.0, 0.0, 0.0};
};

/// Force in N and torque in N·m about the pose's origin, both along world axes.
struct Wrench {
    Vec3 force{0.0, 0.0, 0.0};
    Vec3 torque{0.0, 0.0, 0.0};

    Wrench operator+(const Wrench& other) const { return {force + other.force, torque + other.torque}; }
    Wrench operator*(double factor) const { return {force * factor, torque * factor}; }
};

inline bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool is_finite(const Quat& q) {
    return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}
inline bool is_finite(const Wrench& w) { return is_finite(w.force) && is_finite(w.torque); }

/// True for a valid pose: every number finite and the quaternion of unit length within 1 %.
inline bool is_valid(const Pose& pose) {
    return is_finite(pose.position) && is_finite(pose.orientation) &&
           std::abs(glm::dot(pose.orientation, pose.orientation) - 1.0) < 0.02;
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// Guides a held body to a target while it stays in contact with obstacles.
#pragma once

#include "dsp/coupling/coupling_spring.hpp"
#include "dsp/coupling/held_contact.hpp"

#include <algorithm>
#include <cstddef>

namespace tactus::coupling {

/// Contact of the held body plus a second pair of saturated springs to a target. The hand feels at most the springs'
/// limits and can always pull harder.
class GuidedContact {
public:
    CouplingSprings springs{{1000.0, 8.0}, {1.0, 0.3}};
    double share = 0.0;  ///< scale of the springs' energy, 0 to 1
    Pose target;  ///< of the handle

    /// `contact` must outlive this object.
    explicit GuidedContact(HeldContact& contact) noexcept : contact_(contact) {}

    contact::ContactSum operator()(const Pose& handle, contact::ContactParts parts) noexcept {
        contact::ContactSum sum = contact_(handle, parts);
        if (!(share > 0.0)) return sum;
        const double part = std::min(share, 1.0);
        const auto linear = springs.linear(handle.position - target.position);
        const auto angular = springs.angular(rotation_between(target.orientation, handle.orientation));
        sum.energy += part * (linear.energy + angular.energy);
        for (int axis = 0; axis < 3; ++axis) {
            const auto n = static_cast<std::size_t>(axis);
            sum.gradient[n] += part * linear.force[axis];
            sum.gradient[n + 3] += part * angular.force[axis];
            sum.stiffness[7 * n] += part * linear.curvature;
            sum.stiffness[7 * (n + 3)] += part * angular.curvature;
        }
        return sum;
    }
    double clearance(const Pose& handle) const noexcept { return contact_.clearance(handle); }

private:
    HeldContact& contact_;
};

}  // namespace tactus::coupling

// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell_contact.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::contact {

namespace {

/// Adds one point: energy e, force f = k w φ' and stiffness c = k w φ'' along n with lever r.
void add(ContactSum& sum, double sign, const Vec3& n, const Vec3& r, double e, double f, double c) noexcept {
    const Vec3 moment = glm::cross(r, n);
    const double row[6] = {n.x, n.y, n.z, moment.x, moment.y, moment.z};
    sum.energy += e;
    sum.total_force += f;
    for (std::size_t i = 0; i < 6; ++i) {
        sum.gradient[i] -= sign * f * row[i];
        for (std::size_t j = 0; j <= i; ++j) sum.stiffness[6 * i + j] += c * row[i] * row[j];
    }
}

}  // namespace

ContactSum contact_reference(std::span<const ContactPair> pairs, const Vec3& about, const ContactLaw& law) noexcept {
    ContactSum sum;
    if (!is_finite(about)) return sum;
    const DepthLaw<double> depth_law(law);
    for (const ContactPair& pair : pairs) {
        if (!pair.shell || !pair.map || !is_valid(pair.shell_pose) || !is_valid(pair.map_pose)) continue;
        const Pose shell{pair.shell_pose.position, glm::normalize(pair.shell_pose.orientation)};
        const Pose map{pair.map_pose.position, glm::normalize(pair.map_pose.orientation)};
        const Pose into_map = map.inverse() * shell;
        const Mat3 to_world = glm::mat3_cast(map.orientation), rotation = glm::mat3_cast(shell.orientation);
        const double sign = pair.shell_moves ? 1.0 : -1.0;
        for (std::size_t i = 0; i < pair.shell->size(); ++i) {
            const Vec3 local = into_map.apply(pair.shell->position[i]);
            const volume::Sample sample = law.interpolation == Interpolation::trilinear
                                              ? pair.map->sample(local)
                                              : pair.map->smooth_sample(local);
            ++sum.evaluated;
            if (!sample.inside) continue;
            const DepthEnergy<double> point = depth_law(-sample.value);
            if (!(point.force > 0.0)) continue;
            const double k = law.stiffness * (law.by_area ? static_cast<double>(pair.shell->area[i]) : 1.0);
            const Vec3 n = law.direction == ForceDirection::field_gradient ? to_world * sample.gradient
                                                                           : rotation * -pair.shell->normal[i];
            const Vec3 r = map.apply(local) - about;
            add(sum, sign, n, r, k * point.energy, k * point.force, k * point.stiffness);
            sum.penetration = std::max(sum.penetration, -sample.value);
            ++sum.in_contact;
        }
    }
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < i; ++j) sum.stiffness[6 * j + i] = sum.stiffness[6 * i + j];
    sum.contact_gradient = sum.gradient;
    return sum;
}

}  // namespace tactus::contact

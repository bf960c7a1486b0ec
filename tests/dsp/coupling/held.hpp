// SPDX-License-Identifier: Apache-2.0
// Bodies in a hand for tests of couplings: contact in double precision, paths that a hand is led along.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/contact/shape.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/coupling/quasi_static.hpp"

#include <cmath>
#include <vector>

namespace tactus::test {

/// A voxmap around anything that has a distance and a box, with a margin of `margin` m.
template <class Shape>
Voxmap map_of(const Shape& shape, double voxel, double margin = 3e-3) {
    const Vec3 low = shape.low() - Vec3(margin), extent = shape.high() + Vec3(margin) - low;
    Grid grid;
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(std::ceil(extent[axis] / voxel)) + 1;
    grid.origin = low;
    grid.spacing = Vec3(voxel);
    return sample_voxmap(std::move(grid), [&](const Vec3& p) { return shape.distance(p); });
}

template <class Shape>
Pointshell shell_of(const Shape& shape, double spacing) {
    return make_pointshell(shape.points(spacing));
}

/// A shell held at `grip` against maps that stand still, every point in double precision.
struct Held {
    const Pointshell* shell = nullptr;
    std::vector<ContactPair> pairs;
    ContactLaw law{};
    Pose grip{};
    double free = 0.0;  ///< what `clearance` says
    int calls = 0;

    Held(const Pointshell& held, std::vector<const Voxmap*> maps) : shell(&held) {
        for (const Voxmap* map : maps) pairs.push_back({shell, {}, map, {}, true});
    }
    ContactSum operator()(const Pose& handle, ContactParts) {
        ++calls;
        for (ContactPair& pair : pairs) pair.shell_pose = handle * grip;
        return contact_reference(pairs, handle.position, law);
    }
    double clearance(const Pose&) const { return free; }
};

/// A coupling with the defaults for a body of that size.
inline QuasiStaticCoupling coupling_for(const Held& held, const Pose& start) {
    QuasiStaticCoupling coupling;
    coupling.settings.reach = held.shell->reach + glm::length(held.grip.position);
    coupling.settings.gyration = held.shell->gyration;
    coupling.settings.springs.linear.limit = 40.0;
    coupling.settings.springs.angular.limit = 4.0;
    coupling.reset(start);
    return coupling;
}

}  // namespace tactus::test

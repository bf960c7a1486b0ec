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

/// A voxmap of a shape with room around it for points that are pressed in.
template <class Shape>
contact::Voxmap map_of(const Shape& shape, double voxel, double margin = 3e-3) {
    return contact::voxmap_of(shape, voxel, margin);
}

template <class Shape>
contact::Pointshell shell_of(const Shape& shape, double spacing) {
    return contact::make_pointshell(shape.points(spacing));
}

/// A shell held at `grip` against maps that stand still, every point in double precision.
struct Held {
    const contact::Pointshell* shell = nullptr;
    std::vector<contact::ContactPair> pairs;
    contact::ContactLaw law{};
    Pose grip{};
    double free = 0.0;  ///< what `clearance` says
    int calls = 0;

    Held(const contact::Pointshell& held, std::vector<const contact::Voxmap*> maps) : shell(&held) {
        for (const contact::Voxmap* map : maps) pairs.push_back({shell, {}, map, {}, true});
    }
    contact::ContactSum operator()(const Pose& handle, contact::ContactParts) {
        ++calls;
        for (contact::ContactPair& pair : pairs) pair.shell_pose = handle * grip;
        return contact::contact_reference(pairs, handle.position, law);
    }
    double clearance(const Pose&) const { return free; }
};

/// A coupling with the defaults for a body of that size.
inline coupling::QuasiStaticCoupling coupling_for(const Held& held, const Pose& start) {
    coupling::QuasiStaticCoupling coupling;
    coupling.settings.reach = held.shell->reach + glm::length(held.grip.position);
    coupling.settings.gyration = held.shell->gyration;
    coupling.settings.springs.linear.limit = 40.0;
    coupling.settings.springs.angular.limit = 4.0;
    coupling.reset(start);
    return coupling;
}

}  // namespace tactus::test

// SPDX-License-Identifier: Apache-2.0
// The parameters that every node with contact of pointshells and distance fields has.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "graph/node/node.hpp"

#include <cstddef>
#include <optional>

namespace tactus::nodes {

struct ContactParameters {
    Flag both_ways{false, "the others' points are tried against the held body's field too"};
    Param point_stiffness{internal, "10 N/mm", "0 N/mm", "1e6 N/mm", "of the contact, for each point of the surface"};
    Param area_stiffness{internal, "0 N/m^3", "0 N/m^3", "1e15 N/m^3",
                         "of the contact, for each area of the surface; if not 0 it holds instead"};
    Param blend{"0.03 mm", "0 mm", "10 mm", "half the width within which the contact sets in"};
    Param saturation{"0 mm", "0 mm", "1 m", "depth at which the force of a point levels off; 0: never"};
    Choice interpolation{{"trilinear", "quadratic"}, "of the distance; quadratic suits stiff contact"};
    Choice direction{{"field_gradient", "shell_normal"}, "of the forces; shell_normal is that of the thesis"};
    Param points{structural, "1000000", "1000", "20000000", "of all surfaces together; memory is taken for so many"};
    Param budget{"1e9", "64", "1e9", "most points that one evaluation looks at"};
    TACTUS_GROUP(both_ways, point_stiffness, area_stiffness, blend, saturation, interpolation, direction, points,
                 budget)

    coupling::HeldContact make() const { return coupling::HeldContact(static_cast<std::size_t>(points)); }

    /// Body `held` of the scene against all others from now on, as the parameters say.
    void set(coupling::HeldContact& contact, const coupling::Scene& scene, int held, const Pose& grip) const noexcept {
        contact.set(scene, held, grip, law(), both_ways, static_cast<std::size_t>(budget));
    }

private:
    contact::ContactLaw law() const noexcept {
        contact::ContactLaw law;
        law.by_area = area_stiffness > 0.0;
        law.stiffness = law.by_area ? area_stiffness : point_stiffness;
        law.blend = blend;
        law.saturation = saturation > 2.0 * blend ? saturation.value : 1e6;
        law.interpolation = interpolation.index == 0 ? contact::Interpolation::trilinear : contact::Interpolation::quadratic;
        law.direction = direction.index == 0 ? contact::ForceDirection::field_gradient : contact::ForceDirection::shell_normal;
        return law;
    }
};

}  // namespace tactus::nodes

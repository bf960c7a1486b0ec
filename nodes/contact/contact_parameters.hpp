// SPDX-License-Identifier: Apache-2.0
// Parameters common to all nodes with pointshell contact.
#pragma once

#include "dsp/coupling/held_contact.hpp"
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

#include <cstddef>
#include <optional>

namespace tactus::nodes {

/// Stiffness and blend end where the law does: beyond 1000 N/mm³ the rounding of single precision and the cells of the field
/// are felt as jumps, and a zone wider than the margin of a field begins with a jump at its border.
struct ContactParameters {
    Flag both_ways{false,
                   "also test the other bodies' points against the held body's distance field; needs interpolation = "
                   "\"quadratic\""};
    Param area_stiffness{
        internal, "40 N/mm^3", "0 N/mm^3", "1000 N/mm^3",
        "contact stiffness per surface area: N/mm for each mm^2 that touches, for any spacing of the points"};
    Param point_stiffness{internal, "0 N/mm", "0 N/mm", "1000 N/mm",
                          "contact stiffness per surface point, regardless of its area; if not 0 it replaces "
                          "area_stiffness, and a body is stiffer the denser its points are"};
    Param blend{"0.03 mm", "0 mm", "1 mm", "half the width of the zone in which the force sets in smoothly"};
    Param saturation{"0 mm", "0 mm", "1 m", "depth at which the force of a point stops growing; 0: never"};
    Choice interpolation{{"trilinear", "quadratic"},
                         "of the distance field; quadratic has no jumps in force, and suits stiff contact"};
    Choice direction{{"field_gradient", "shell_normal"}, "of the contact forces; shell_normal is that of the thesis"};
    Param points{structural, "1000000", "1000", "20000000",
                 "of all surfaces together; memory is reserved for this many"};
    Param budget{discrete, "1e9", "64", "1e9", "maximum number of points per evaluation"};
    TACTUS_GROUP(both_ways, area_stiffness, point_stiffness, blend, saturation, interpolation, direction, points,
                 budget)

    /// Throws Error. Many points of another body cross an edge of the held one at the same time: where the gradient jumps, as
    /// that of a trilinear field does at the faces of its cells, the force jumps by newtons.
    coupling::HeldContact make(const Setup& setup) const {
        if (both_ways && interpolation.is("trilinear"))
            setup.fail(
                "both_ways needs interpolation = \"quadratic\": with a trilinear field the force jumps where "
                "points of the other bodies cross an edge of the held one");
        return coupling::HeldContact(static_cast<std::size_t>(points));
    }

    /// Sets up contact of body `held` of the scene with all others, with these parameters.
    void set(coupling::HeldContact& contact, const coupling::Scene& scene, int held, const Pose& grip) const noexcept {
        contact.set(scene, held, grip, law(), both_ways, static_cast<std::size_t>(budget));
    }

    /// Force of a saturated contact divided by the depth at which saturation begins, N/m. Used because the derivative
    /// of the points' force is zero there. 0 without saturation.
    double secant(const contact::ContactSum& now) const noexcept {
        const double depth = now.penetration + blend;
        return saturates() && depth > 0.0 ? glm::length(now.wrench().force) / depth : 0.0;
    }

private:
    bool saturates() const noexcept { return saturation > 2.0 * blend; }

    contact::ContactLaw law() const noexcept {
        contact::ContactLaw law;
        law.by_area = !(point_stiffness > 0.0);
        law.stiffness = law.by_area ? area_stiffness : point_stiffness;
        law.blend = blend;
        law.saturation = saturates() ? saturation.value : 1e6;
        law.interpolation =
            interpolation.index == 0 ? contact::Interpolation::trilinear : contact::Interpolation::quadratic;
        law.direction =
            direction.index == 0 ? contact::ForceDirection::field_gradient : contact::ForceDirection::shell_normal;
        return law;
    }
};

}  // namespace tactus::nodes

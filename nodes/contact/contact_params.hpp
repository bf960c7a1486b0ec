// SPDX-License-Identifier: Apache-2.0
// The parameters that every node with contact of pointshells and distance fields has.
#pragma once

#include "dsp/contact/contact_law.hpp"
#include "graph/param.hpp"

namespace tactus::nodes {

/// `area_stiffness` above zero weighs points by the surface they stand for.
inline ContactLaw contact_law(const Param& point_stiffness, const Param& area_stiffness, const Param& blend,
                              const Param& saturation, const Choice& interpolation, const Choice& direction) noexcept {
    ContactLaw law;
    law.by_area = area_stiffness > 0.0;
    law.stiffness = law.by_area ? area_stiffness : point_stiffness;
    law.blend = blend;
    law.saturation = saturation > 2.0 * blend ? saturation.value : 1e6;
    law.interpolation = interpolation.index == 0 ? Interpolation::trilinear : Interpolation::quadratic;
    law.direction = direction.index == 0 ? ForceDirection::field_gradient : ForceDirection::shell_normal;
    return law;
}

}  // namespace tactus::nodes

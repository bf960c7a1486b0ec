// SPDX-License-Identifier: Apache-2.0
// The units of what wires carry.
#pragma once

#include "dsp/expression/measure.hpp"
#include "graph/compile/plan.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::compile {

/// A unit that a port states, or that follows from those of others.
struct WireUnit {
    /// Quantities of one kind of unit that are not the same: turns per second and events per second, energy and torque.
    enum class Sense : std::uint8_t { any, hertz, per_second, energy, torque };

    expression::Measure measure;
    Sense sense = Sense::any;  ///< `any` when it follows from others
    std::string text;  ///< "N/m"

    /// One may feed the other.
    bool agrees_with(const WireUnit& other) const {
        return measure == other.measure && (sense == Sense::any || other.sense == Sense::any || sense == other.sense);
    }
};

/// "N/m"; nothing for an empty text. Throws Error for an unknown unit.
std::optional<WireUnit> stated_unit(std::string_view text);

/// Of each node, in the order of its ports; nothing where none is known. Numbers, signals and vectors only.
struct PlanUnits {
    std::vector<std::vector<std::optional<WireUnit>>> inputs;  ///< stated by the port, or brought by its wire
    std::vector<std::vector<std::optional<WireUnit>>> outputs;  ///< stated, or following from the inputs
};

/// Carries the units that ports state through the nodes that say how (`UnitRule`). A plan whose wires are resolved.
PlanUnits find_units(const Plan& plan);

/// A wire between two ends of different known units is a problem at the wire, which names both; so are two inputs of a
/// node that need one unit.
void check_units(const Plan& plan, patch::Problems& problems);

}  // namespace tactus::compile

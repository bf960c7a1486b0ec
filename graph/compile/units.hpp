// SPDX-License-Identifier: Apache-2.0
// Units of the values on wires.
#pragma once

#include "graph/compile/schedule.hpp"
#include "graph/formula/measure.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::compile {

/// A unit that a port states, or that is derived from the units of other ports.
struct WireUnit {
    /// Distinguishes quantities of equal dimension: turns and events per second, energy and torque.
    enum class Sense : std::uint8_t { any, hertz, per_second, energy, torque };

    formula::Measure measure;
    Sense sense = Sense::any;  ///< `any` if derived from other ports
    std::string text;  ///< "N/m"

    /// Returns true if a port of one unit may feed a port of the other.
    bool agrees_with(const WireUnit& other) const {
        return measure == other.measure && (sense == Sense::any || other.sense == Sense::any || sense == other.sense);
    }
};

/// Returns the unit of text such as "N/m", or nothing for an empty text. Throws Error for an unknown unit.
std::optional<WireUnit> stated_unit(std::string_view text);

/// Units of each node's ports, in their order; empty where unknown. For numbers, signals and vectors only.
struct ScheduleUnits {
    std::vector<std::vector<std::optional<WireUnit>>> inputs;  ///< stated by the port, or that of its wire
    std::vector<std::vector<std::optional<WireUnit>>> outputs;  ///< stated, or derived from the inputs
};

/// Propagates the units that ports state through the nodes that declare a `UnitRule`. Requires resolved wires.
ScheduleUnits find_units(const Schedule& plan);

/// Reports each wire between ports of different known units, with both units, and each node whose inputs must have one
/// unit but do not.
void check_units(const Schedule& plan, patch::Problems& problems);

}  // namespace tactus::compile

// SPDX-License-Identifier: Apache-2.0
// Slopes of the nodes that shape values (formulas, curves, gains), for the analysis of stiffness.
#pragma once

#include "graph/compile/units.hpp"

#include <optional>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace tactus::analyse {

using DrivenParams = std::unordered_set<const Param*>;

/// Known properties of the law of a node that shapes values.
struct KnownLaw {
    std::optional<double> newton_per_metre;  ///< largest slope if the node computes a force from positions
};

/// Slopes of nodes over their inputs, classified by units.
class Laws {
public:
    /// `driven` lists the parameters of `plan` that wires drive. Both must outlive this object.
    Laws(const compile::Schedule& plan, const DrivenParams& driven);

    /// Returns nothing if the law has no known bound: the node states no slope over an input that a hand reaches, a
    /// wire drives a parameter, a value is amplified, or the units are neither those of a spring or a damper nor
    /// unchanged.
    std::optional<KnownLaw> of(std::size_t node, const std::vector<bool>& reached_by_hands) const;

private:
    void find_units_given();

    const compile::Schedule& plan_;
    const DrivenParams& driven_;
    compile::ScheduleUnits units_;
    std::vector<std::vector<const compile::ScheduleWire*>> wires_into_, wires_from_;
    std::vector<std::optional<compile::WireUnit>>
        given_;  ///< unit of each node's output, stated or required by its readers
};

}  // namespace tactus::analyse

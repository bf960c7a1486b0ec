// SPDX-License-Identifier: Apache-2.0
// How stiff the laws of nodes are that shape values: formulas, curves, gains.
#pragma once

#include "graph/compile/units.hpp"

#include <optional>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace tactus::analyse {

using DrivenParams = std::unordered_set<const Param*>;

/// What is known of the law of a node that shapes values.
struct KnownLaw {
    std::optional<double> newton_per_metre;  ///< largest slope of a force over positions, if it gives one
};

/// Slopes over the inputs of nodes, by what they mean.
class Laws {
public:
    /// `plan` and `driven`, its parameters that wires drive, must outlive this.
    Laws(const compile::Plan& plan, const DrivenParams& driven);

    /// Nothing when a slope over an input that a hand reaches is not known: there is no bound, a wire drives a
    /// parameter, the units say nothing, or a value of one unit is made larger.
    std::optional<KnownLaw> of(std::size_t node, const std::vector<bool>& reached_by_hands) const;

private:
    void find_units_given();

    const compile::Plan& plan_;
    const DrivenParams& driven_;
    compile::PlanUnits units_;
    std::vector<std::vector<const compile::PlanWire*>> wires_into_, wires_from_;
    std::vector<std::optional<compile::WireUnit>>
        given_;  ///< unit of each node's output, or that which its readers take
};

}  // namespace tactus::analyse

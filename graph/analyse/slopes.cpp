// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/slopes.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::analyse {

namespace {

bool is(const std::optional<compile::WireUnit>& unit, std::string_view text) {
    return unit && unit->measure == expression::parse_measured_unit(text).measure;
}

}  // namespace

Laws::Laws(const compile::Plan& plan, const DrivenParams& driven)
    : plan_(plan),
      driven_(driven),
      units_(compile::find_units(plan)),
      wires_into_(plan.nodes.size()),
      wires_from_(plan.nodes.size()) {
    for (const compile::PlanWire& wire : plan.wires) {
        if (wire.from_node < 0 || wire.to_input < 0) continue;
        wires_into_[static_cast<std::size_t>(wire.to_node)].push_back(&wire);
        wires_from_[static_cast<std::size_t>(wire.from_node)].push_back(&wire);
    }
}

std::optional<compile::WireUnit> Laws::unit_given(std::size_t node) const {
    if (units_.outputs[node].size() == 1 && units_.outputs[node][0]) return units_.outputs[node][0];
    std::vector<std::size_t> to_follow{node};
    std::vector<bool> is_known(plan_.nodes.size(), false);
    while (!to_follow.empty()) {
        const std::size_t from = to_follow.back();
        to_follow.pop_back();
        for (const compile::PlanWire* wire : wires_from_[from]) {
            const auto to = static_cast<std::size_t>(wire->to_node);
            if (const auto& taken = units_.inputs[to][static_cast<std::size_t>(wire->to_input)]) return taken;
            if (plan_.nodes[to].type->units != UnitRule::same || is_known[to]) continue;
            is_known[to] = true;
            to_follow.push_back(to);
        }
    }
    return std::nullopt;
}

std::optional<KnownLaw> Laws::of(std::size_t n, const std::vector<bool>& reached_by_hands) const {
    const compile::PlanNode& node = plan_.nodes[n];
    if (!node.type->slopes || node.outputs.size() != 1) return std::nullopt;
    for (const auto& [name, param] : node.params)
        if (driven_.contains(param)) return std::nullopt;
    std::vector<PortSlope> slopes;
    try {
        slopes = node.type->slopes(node.instance.get());
    } catch (const Error&) {
        return std::nullopt;  // `prepare` says what is wrong
    }
    const std::optional<compile::WireUnit> out = unit_given(n);
    KnownLaw law;
    double squares = 0.0;
    bool has_positions = false;
    for (const compile::PlanWire* wire : wires_into_[n]) {
        if (!reached_by_hands[static_cast<std::size_t>(wire->from_node)]) continue;
        const auto input = static_cast<std::size_t>(wire->to_input);
        const auto slope = std::ranges::find(slopes, node.inputs[input].name, &PortSlope::input);
        if (slope == slopes.end() || !std::isfinite(slope->largest)) return std::nullopt;
        const auto& in = units_.inputs[n][input];
        if (is(in, "m") && is(out, "N")) {
            has_positions = true;
            squares += slope->largest * slope->largest;
        } else if (!(is(in, "m/s") && is(out, "N"))) {
            const bool keeps_unit = in && out ? in->measure == out->measure : node.type->units == UnitRule::same;
            if (!keeps_unit || slope->largest > 1.0) return std::nullopt;
        }
    }
    if (has_positions) law.newton_per_metre = std::sqrt(squares);
    return law;
}

}  // namespace tactus::analyse

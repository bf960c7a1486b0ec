// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/slopes.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::analyse {

namespace {

bool is(const std::optional<compile::WireUnit>& unit, std::string_view text) {
    return unit && unit->measure == formula::parse_measured_unit(text).measure;
}

}  // namespace

Laws::Laws(const compile::Schedule& plan, const DrivenParams& driven)
    : plan_(plan),
      driven_(driven),
      units_(compile::find_units(plan)),
      wires_into_(plan.nodes.size()),
      wires_from_(plan.nodes.size()) {
    for (const compile::ScheduleWire& wire : plan.wires) {
        if (wire.from_node < 0 || wire.to_input < 0) continue;
        wires_into_[static_cast<std::size_t>(wire.to_node)].push_back(&wire);
        wires_from_[static_cast<std::size_t>(wire.from_node)].push_back(&wire);
    }
    find_units_given();
}

void Laws::find_units_given() {
    given_.resize(plan_.nodes.size());
    std::vector<std::size_t> known;
    for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
        if (units_.outputs[n].size() == 1) given_[n] = units_.outputs[n][0];
        for (const compile::ScheduleWire* wire : wires_from_[n])
            if (!given_[n])
                given_[n] =
                    units_.inputs[static_cast<std::size_t>(wire->to_node)][static_cast<std::size_t>(wire->to_input)];
        if (given_[n]) known.push_back(n);
    }
    // From the readers back, through nodes that keep a unit. Each node is reached once.
    for (std::size_t head = 0; head < known.size(); ++head) {
        const std::size_t reader = known[head];
        if (plan_.nodes[reader].type->units != UnitRule::same) continue;
        for (const compile::ScheduleWire* wire : wires_into_[reader]) {
            const auto from = static_cast<std::size_t>(wire->from_node);
            if (given_[from]) continue;
            given_[from] = given_[reader];
            known.push_back(from);
        }
    }
}

std::optional<KnownLaw> Laws::of(std::size_t n, const std::vector<bool>& reached_by_hands) const {
    const compile::ScheduleNode& node = plan_.nodes[n];
    if (!node.type->slopes || node.outputs.size() != 1) return std::nullopt;
    for (const auto& [name, param] : node.params)
        if (driven_.contains(param)) return std::nullopt;
    std::vector<PortSlope> slopes;
    try {
        slopes = node.type->slopes(node.instance.get());
    } catch (const Error&) {
        return std::nullopt;  // `prepare` says what is wrong
    }
    const std::optional<compile::WireUnit>& out = given_[n];
    KnownLaw law;
    double squares = 0.0;
    bool has_positions = false;
    for (const compile::ScheduleWire* wire : wires_into_[n]) {
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

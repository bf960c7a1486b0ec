// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/units.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::compile {

namespace {

using formula::Measure;
using Sense = WireUnit::Sense;

const Measure& per_second() {
    static const Measure measure = formula::parse_measured_unit("1/s").measure;
    return measure;
}

Sense sense_of(const Measure& measure, std::string_view text) {
    static const Measure work = formula::parse_measured_unit("N m").measure;
    if (measure == per_second()) return text.find("Hz") != text.npos ? Sense::hertz : Sense::per_second;
    if (measure == work) return text.find('J') != text.npos ? Sense::energy : Sense::torque;
    return Sense::any;
}

/// Has a unit, not one for each part.
bool has_one_unit(const ValueType* type) {
    return type == &value::number || type == &value::signal || type == &value::vector;
}

class Finder {
public:
    explicit Finder(const Schedule& plan) : plan_(plan), wires_from_(plan.nodes.size()) {
        for (const ScheduleNode& node : plan.nodes) {
            units.inputs.emplace_back(node.inputs.size());
            units.outputs.emplace_back(node.outputs.size());
        }
        for (const ScheduleWire& wire : plan.wires) {
            if (wire.from_node < 0 || wire.to_input < 0) continue;
            wires_from_[static_cast<std::size_t>(wire.from_node)].push_back(&wire);
        }
    }

    void find() {
        stops.resize(plan_.nodes.size());
        for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
            const ScheduleNode& node = plan_.nodes[n];
            for (std::size_t k = 0; k < node.inputs.size(); ++k)
                if (has_one_unit(node.inputs[k].port->type))
                    units.inputs[n][k] = stated(node, node.inputs[k].name, node.inputs[k].port->unit);
            for (std::size_t k = 0; k < node.outputs.size(); ++k)
                if (has_one_unit(node.outputs[k].port->type))
                    units.outputs[n][k] = stated(node, node.outputs[k].name, node.outputs[k].port->unit);
        }
        for (std::size_t n = 0; n < plan_.nodes.size(); ++n) changed_.push_back(n);
        while (!changed_.empty()) {
            const std::size_t n = changed_.back();
            changed_.pop_back();
            for (const ScheduleWire* wire : wires_from_[n]) bring(*wire);
        }
    }

    ScheduleUnits units;
    std::vector<bool> stops;  ///< nodes whose inputs disagree: nothing follows from them

private:
    static std::optional<WireUnit> stated(const ScheduleNode& node, const std::string& port, const char* unit) {
        if (*unit != '\0') return stated_unit(unit);
        if (!node.type->unit_of) return std::nullopt;
        try {
            return stated_unit(node.type->unit_of(node.instance.get(), port));
        } catch (const Error&) {
            return std::nullopt;  // `prepare` says what is wrong with the text
        }
    }

    void bring(const ScheduleWire& wire) {
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        const auto& unit = units.outputs[from][static_cast<std::size_t>(wire.from_output)];
        auto& at = units.inputs[to][static_cast<std::size_t>(wire.to_input)];
        if (!unit || at || !has_one_unit(plan_.nodes[to].inputs[static_cast<std::size_t>(wire.to_input)].port->type))
            return;
        at = unit;
        pass_on(to);
    }

    /// Units of the outputs of a node, once those of its inputs suffice.
    void pass_on(std::size_t n) {
        const ScheduleNode& node = plan_.nodes[n];
        if (node.type->units == UnitRule::none || stops[n]) return;
        const std::optional<WireUnit> unit = result(n);
        if (!unit) return;
        bool is_new = false;
        for (std::size_t k = 0; k < node.outputs.size(); ++k) {
            const Output& port = *node.outputs[k].port;
            if (units.outputs[n][k] || *port.unit != '\0' || !has_one_unit(port.type)) continue;
            units.outputs[n][k] = unit;
            is_new = true;
        }
        if (is_new) changed_.push_back(n);
    }

    std::optional<WireUnit> result(std::size_t n) const {
        const ScheduleNode& node = plan_.nodes[n];
        std::vector<const WireUnit*> known;
        bool all_are_known = true;
        for (std::size_t k = 0; k < node.inputs.size(); ++k) {
            const Input& port = *node.inputs[k].port;
            if (!takes_part(port)) continue;
            if (units.inputs[n][k]) known.push_back(&*units.inputs[n][k]);
            else all_are_known = false;
        }
        if (known.empty()) return std::nullopt;
        if (node.type->units == UnitRule::same) return *known.front();
        if (!all_are_known) return std::nullopt;
        static const Measure second = formula::parse_measured_unit("s").measure;
        Measure measure = known.front()->measure;
        try {
            switch (node.type->units) {
                case UnitRule::product:
                    for (std::size_t i = 1; i < known.size(); ++i)
                        measure = formula::combined(measure, known[i]->measure, 1);
                    break;
                case UnitRule::quotient:
                    for (std::size_t i = 1; i < known.size(); ++i)
                        measure = formula::combined(measure, known[i]->measure, -1);
                    break;
                case UnitRule::rate: measure = formula::combined(measure, second, -1); break;
                case UnitRule::integral: measure = formula::combined(measure, second, 1); break;
                default: return std::nullopt;
            }
        } catch (const Error&) {
            return std::nullopt;  // an exponent beyond 100
        }
        return WireUnit{measure, Sense::any, measure.text()};
    }

public:
    /// An input whose unit becomes that of the outputs.
    static bool takes_part(const Input& port) {
        return port.connected && *port.unit == '\0' && has_one_unit(port.type);
    }

private:
    const Schedule& plan_;
    std::vector<std::vector<const ScheduleWire*>> wires_from_;
    std::vector<std::size_t> changed_;  // nodes whose outputs are to be followed
};

std::string hint(const WireUnit& a, const WireUnit& b) {
    static const Measure angular = formula::parse_measured_unit("rad/s").measure;
    const auto is_rate = [](const WireUnit& u) { return u.measure == per_second() || u.measure == angular; };
    if (is_rate(a) && is_rate(b)) return "; 1 Hz is 2 pi rad/s, and 1/s is neither: convert by an expression";
    if (a.measure == b.measure) return "; a torque is no energy: convert by an expression";
    return {};
}

class Checker {
public:
    Checker(const Schedule& plan, patch::Problems& problems)
        : plan_(plan), problems_(problems), stops_(plan.nodes.size(), false) {}

    void check() {
        // One conflict causes others downstream; stop after `most` of them.
        constexpr int most = 100;
        for (int told = 0; told < most; ++told) {
            find();
            if (!tell_conflict()) break;
        }
        for (const ScheduleWire& wire : plan_.wires)
            if (wire.from_node >= 0) check_wire(wire);
    }

private:
    void find() {
        Finder finder(plan_);
        finder.stops = stops_;
        finder.find();
        units_ = std::move(finder.units);
    }

    bool tell_conflict() {
        for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
            if (plan_.nodes[n].type->units != UnitRule::same || stops_[n] || agree(n)) continue;
            stops_[n] = true;
            return true;
        }
        return false;
    }

    std::string name_of(const ScheduleWire& wire, bool source) const {
        const ScheduleNode& from = plan_.nodes[static_cast<std::size_t>(wire.from_node)];
        const ScheduleNode& to = plan_.nodes[static_cast<std::size_t>(wire.to_node)];
        if (source) return from.name + "." + from.outputs[static_cast<std::size_t>(wire.from_output)].name;
        if (wire.to_input >= 0) return to.name + "." + to.inputs[static_cast<std::size_t>(wire.to_input)].name;
        for (const auto& [name, param] : to.params)
            if (param == wire.param) return to.name + "." + name;
        return to.name;
    }

    void check_wire(const ScheduleWire& wire) {
        const auto& given =
            units_.outputs[static_cast<std::size_t>(wire.from_node)][static_cast<std::size_t>(wire.from_output)];
        const std::optional<WireUnit> taken =
            wire.to_input < 0
                ? stated_unit(wire.param->unit)
                : units_.inputs[static_cast<std::size_t>(wire.to_node)][static_cast<std::size_t>(wire.to_input)];
        if (!given || !taken || given->agrees_with(*taken)) return;
        problems_.add(wire.where, fmt::format("'{}' gives {}, but '{}' takes {}{}", name_of(wire, true), given->text,
                                              name_of(wire, false), taken->text, hint(*given, *taken)));
    }

    /// The inputs of a sum, a choice and the like have one unit; otherwise the first that differs is a problem.
    bool agree(std::size_t n) {
        const ScheduleNode& node = plan_.nodes[n];
        std::size_t first = node.inputs.size();
        for (std::size_t k = 0; k < node.inputs.size(); ++k) {
            const auto& unit = units_.inputs[n][k];
            if (!unit || !Finder::takes_part(*node.inputs[k].port)) continue;
            if (first == node.inputs.size()) {
                first = k;
                continue;
            }
            const WireUnit& other = *units_.inputs[n][first];
            if (unit->agrees_with(other)) continue;
            problems_.add(node.inputs[k].where,
                          fmt::format("'{}.{}' gets {}, but '{}.{}' gets {}: '{}' takes one unit{}", node.name,
                                      node.inputs[k].name, unit->text, node.name, node.inputs[first].name, other.text,
                                      node.name, hint(*unit, other)));
            return false;
        }
        return true;
    }

    const Schedule& plan_;
    patch::Problems& problems_;
    std::vector<bool> stops_;
    ScheduleUnits units_;
};

}  // namespace

std::optional<WireUnit> stated_unit(std::string_view text) {
    if (text.empty()) return std::nullopt;
    const Measure measure = formula::parse_measured_unit(text).measure;
    return WireUnit{measure, sense_of(measure, text), std::string(text)};
}

ScheduleUnits find_units(const Schedule& plan) {
    Finder finder(plan);
    finder.find();
    return std::move(finder.units);
}

void check_units(const Schedule& plan, patch::Problems& problems) { Checker(plan, problems).check(); }

}  // namespace tactus::compile

// SPDX-License-Identifier: Apache-2.0
#include "graph/patch_measure.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus {

namespace {

const std::string sweep_name = "measure_sweep", record_name = "measure_record";

struct End {
    const PatchNode* node = nullptr;
    std::string port, unit;
    bool is_input = false;
};

/// Finds one port of a node by name; every signal port is offered when it is another.
struct SignalPorts final : MemberVisitor {
    explicit SignalPorts(std::string_view wanted_) : wanted(wanted_) {}

    void input(std::string_view name, Input& port) override { look(name, port.type, port.unit, true); }
    void output(std::string_view name, Output& port) override { look(name, port.type, port.unit, false); }

    std::string_view wanted;
    std::vector<std::string> names;
    bool found = false, is_input = false;
    std::string unit;

private:
    void look(std::string_view name, const ValueType* type, std::string_view its_unit, bool input) {
        if (type != &value::signal) return;
        names.emplace_back(name);
        if (name != wanted) return;
        found = true;
        is_input = input;
        unit = its_unit;
    }
};

End find_end(const Patch& patch, const std::string& text, std::string_view option, Catalogue catalogue) {
    const SourceLocation where{fmt::format("{} {}", option, text), 0, 0};
    const std::size_t dot = text.find('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == text.size()) throw Error(where, "write NODE.PORT");
    const std::string name = text.substr(0, dot), port = text.substr(dot + 1);
    const auto node = std::ranges::find(patch.nodes, name, &PatchNode::name);
    if (node == patch.nodes.end()) {
        std::vector<std::string> names;
        for (const PatchNode& n : patch.nodes) names.push_back(n.name);
        throw Error(where, fmt::format("no node '{}'{}", name, did_you_mean(name, names)));
    }
    const auto type = std::ranges::find(catalogue, node->type, [](const NodeType* t) { return t->name; });
    if (type == catalogue.end()) throw Error(where, fmt::format("node '{}' has an unknown type", name));
    const NodeInstance instance((*type)->create(), (*type)->destroy);
    SignalPorts ports(port);
    (*type)->visit(instance.get(), ports);
    if (!ports.found) {
        std::string list;
        for (const std::string& known : ports.names) list += (list.empty() ? "" : ", ") + known;
        throw Error(where, fmt::format("'{}' has no signal '{}'{}; its signals: {}", name, port,
                                       did_you_mean(port, ports.names), list.empty() ? "none" : list));
    }
    return {&*node, port, ports.unit, ports.is_input};
}

/// Leaves only what leads to the node, in the order of the patch.
void keep_what_leads_to(const std::string& last, Patch& patch) {
    std::vector<std::string> kept{last};
    for (std::size_t i = 0; i < kept.size(); ++i)
        for (const PatchWire& wire : patch.wires)
            if (wire.to_node == kept[i] && std::ranges::find(kept, wire.from_node) == kept.end())
                kept.push_back(wire.from_node);
    const auto is_dropped = [&](const std::string& name) { return std::ranges::find(kept, name) == kept.end(); };
    std::erase_if(patch.nodes, [&](const PatchNode& node) { return is_dropped(node.name); });
    std::erase_if(patch.wires, [&](const PatchWire& wire) { return is_dropped(wire.to_node); });
}

}  // namespace

MeasuredPatch measured_patch(const Patch& patch, const MeasuredPath& path, Catalogue catalogue) {
    const End in = find_end(patch, path.in, "--in", catalogue), out = find_end(patch, path.out, "--out", catalogue);
    const SourceLocation where{fmt::format("--in {} --out {}", path.in, path.out), 0, 0};
    if (out.is_input) throw Error(where, fmt::format("'{}' is an input; --out takes what a node puts out", path.out));
    if (in.node->group != out.node->group ||
        (in.node->group.empty() && parse_rate(in.node->rate) != parse_rate(out.node->rate)))
        throw Error(where, "both ends must run at one rate, in one group");

    MeasuredPatch made{patch, in.node->rate, in.unit, out.unit, record_name + ".wav"};
    Patch& measured = made.patch;
    if (!in.node->group.empty()) {
        const auto group = std::ranges::find(patch.groups, in.node->group, &PatchGroup::name);
        if (group != patch.groups.end()) made.rate = group->rate;
    }
    PatchNode sweep{sweep_name, "sweep", in.node->rate, in.node->group, where, where, where, path.sweep};
    PatchNode record{record_name, "record", in.node->rate, in.node->group, where, where, where, {}};
    if (in.is_input) {
        std::erase_if(measured.wires,
                      [&](const PatchWire& w) { return w.to_node == in.node->name && w.to_port == in.port; });
        measured.wires.push_back({sweep_name, "signal", in.node->name, in.port, WireMode::hold, false, 0, where});
    } else {
        for (PatchWire& wire : measured.wires)
            if (wire.from_node == in.node->name && wire.from_port == in.port)
                wire.from_node = sweep_name, wire.from_port = "signal";
    }
    measured.wires.push_back({out.node->name, out.port, record_name, "in", WireMode::hold, false, 0, where});
    measured.nodes.push_back(std::move(sweep));
    measured.nodes.push_back(std::move(record));
    keep_what_leads_to(record_name, measured);
    if (std::ranges::find(measured.nodes, sweep_name, &PatchNode::name) == measured.nodes.end())
        throw Error(where, fmt::format("no wires lead from '{}' to '{}'", path.in, path.out));
    return made;
}

}  // namespace tactus

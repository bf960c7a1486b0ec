// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/patch_parts.hpp"

#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace tactus::compile {

namespace {

/// Whether a node has an output whose type its wires decide.
struct OpenOutputs final : MemberVisitor {
    void output(std::string_view, Output& port) override { found |= port.type == &value::undecided; }
    bool found = false;
};

/// Finds a signal port of a node by name, and collects the names of all signal ports for the message.
struct SignalPorts final : MemberVisitor {
    SignalPorts(std::string_view wanted_, bool passes_on_) : wanted(wanted_), passes_on(passes_on_) {}

    // A port of several types counts where the output has the type of the input: which one, the wires decide.
    void input(std::string_view name, Input& port) override {
        const bool takes_signals = passes_on && port.kind == InputKind::any && (port.takes & kinds::signal);
        look(name, port.type == &value::signal || takes_signals, port.unit, true);
    }
    void output(std::string_view name, Output& port) override {
        look(name, port.type == &value::signal || port.type == &value::undecided, port.unit, false);
    }

    std::string_view wanted;
    bool passes_on = false;
    std::vector<std::string> names;
    bool found = false, is_input = false;
    std::string unit;

private:
    void look(std::string_view name, bool may_be_signal, std::string_view its_unit, bool input) {
        if (!may_be_signal) return;
        names.emplace_back(name);
        if (name != wanted) return;
        found = true;
        is_input = input;
        unit = its_unit;
    }
};

}  // namespace

SignalEnd find_signal(const patch::Patch& patch, const std::string& text, std::string_view option,
                      Catalogue catalogue) {
    const SourceLocation where{fmt::format("{} {}", option, text), 0, 0};
    const std::size_t dot = text.find('.');
    if (dot == std::string::npos || dot == 0 || dot + 1 == text.size()) throw Error(where, "write NODE.PORT");
    const std::vector<patch::NamedEnd> ends = patch::ends_within(patch, text.substr(0, dot), text.substr(dot + 1));
    if (ends.size() > 1) {
        std::string several;
        for (const patch::NamedEnd& end : ends)
            several += fmt::format("{}{}.{}", several.empty() ? "" : ", ", end.node, end.name);
        throw Error(where, fmt::format("'{}' leads to several ports; name one of them: {}", text, several));
    }
    const auto& [name, port] = ends.front();
    const auto node = std::ranges::find(patch.nodes, name, &patch::PatchNode::name);
    if (node == patch.nodes.end()) {
        std::vector<std::string> names;
        for (const patch::PatchNode& n : patch.nodes) names.push_back(n.name);
        throw Error(where, fmt::format("no node '{}'{}", name, did_you_mean(name, names)));
    }
    const auto type = std::ranges::find(catalogue, node->type, [](const NodeType* t) { return t->name; });
    if (type == catalogue.end()) throw Error(where, fmt::format("node '{}' has an unknown type", name));
    const NodeInstance instance((*type)->create(), (*type)->destroy);
    OpenOutputs open;
    (*type)->visit(instance.get(), open);
    SignalPorts ports(port, open.found);
    (*type)->visit(instance.get(), ports);
    if (!ports.found) {
        std::string list;
        for (const std::string& known : ports.names) list += (list.empty() ? "" : ", ") + known;
        throw Error(where, fmt::format("'{}' has no signal '{}'{}; its signals: {}", name, port,
                                       did_you_mean(port, ports.names), list.empty() ? "none" : list));
    }
    return {&*node, port, ports.unit, ports.is_input};
}

void keep_what_leads_to(std::vector<std::string> kept, patch::Patch& patch) {
    std::unordered_map<std::string, std::vector<std::string>> sources;  // of each node
    for (const patch::PatchWire& wire : patch.wires) sources[wire.to_node].push_back(wire.from_node);
    std::unordered_set<std::string> known(kept.begin(), kept.end());
    while (!kept.empty()) {
        const std::string node = std::move(kept.back());
        kept.pop_back();
        for (const std::string& source : sources[node])
            if (known.insert(source).second) kept.push_back(source);
    }
    const auto is_dropped = [&](const std::string& name) { return !known.contains(name); };
    std::erase_if(patch.nodes, [&](const patch::PatchNode& node) { return is_dropped(node.name); });
    std::erase_if(patch.wires, [&](const patch::PatchWire& wire) { return is_dropped(wire.to_node); });
}

}  // namespace tactus::compile

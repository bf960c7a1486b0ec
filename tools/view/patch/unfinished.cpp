// SPDX-License-Identifier: Apache-2.0
#include "tools/view/patch/unfinished.hpp"

#include "graph/patch/sub_patch.hpp"
#include "nodes/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

namespace tactus::view {

namespace {

struct PortLister : MemberVisitor {
    TypePorts ports;

    /// Null where the wires decide.
    static const ValueType* known(const ValueType* type) { return type == &value::undecided ? nullptr : type; }

    void input(std::string_view name, Input& port) override {
        PicturePort made{std::string(name),
                         std::string(port.about),
                         std::string(port.unit),
                         known(port.type),
                         port.is_optional,
                         false,
                         false,
                         {}};
        made.takes_many = port.kind == InputKind::events;
        ports.inputs.push_back(std::move(made));
    }
    void output(std::string_view name, Output& port) override {
        ports.outputs.push_back({std::string(name),
                                 std::string(port.about),
                                 std::string(port.unit),
                                 known(port.type),
                                 true,
                                 false,
                                 false,
                                 {}});
    }
    void param(std::string_view name, Param& param) override {
        if (!param.is_structural) ports.params.emplace_back(name, param.unit);
    }
    void asset(std::string_view name, AssetParam& asset) override {
        ports.files.push_back({std::string(name), std::string(asset.type_name)});
        if (!asset.is_optional) ports.assets.emplace_back(name);
    }
};

using Nodes = std::unordered_map<std::string_view, const patch::PatchNode*>;

/// What a node lacks in a patch; empty: nothing.
std::string lack_of(const patch::PatchNode& node, const TypePorts& ports, const std::set<std::string>& fed) {
    for (const PicturePort& port : ports.inputs)
        if (!port.is_optional && !fed.contains(node.name + "." + port.name))
            return fmt::format("input '{}' has no wire", port.name);
    for (const std::string& asset : ports.assets)
        if (std::ranges::find(node.settings, asset, &OptionText::name) == node.settings.end())
            return fmt::format("'{}' needs a file", asset);
    return {};
}

class Finder {
public:
    Finder(const patch::Patch& patch, patch::Problems& problems) : patch_(patch), problems_(problems) {
        for (const patch::PatchNode& node : patch.nodes) nodes_.emplace(node.name, &node);
    }

    Unfinished find() {
        find_nodes();
        if (made_.nodes.empty()) return {};
        for (const patch::PatchWire& wire : patch_.wires)
            if (lacks_.contains(wire.from_node) || lacks_.contains(wire.to_node)) {
                check(wire);
                made_.wires.push_back(wire);
            }
        return std::move(made_);
    }

private:
    void find_nodes() {
        std::set<std::string> fed;
        for (const patch::PatchWire& wire : patch_.wires) fed.insert(wire.to_node + "." + wire.to_port);
        for (const patch::PatchNode& node : patch_.nodes)
            if (const TypePorts* ports = ports_of_type(node.type))
                if (std::string lack = lack_of(node, *ports, fed); !lack.empty()) lacks_[node.name] = std::move(lack);
        if (lacks_.empty()) return;
        // What an unfinished node feeds is unfinished as well, unless it can do without.
        for (bool changed = true; changed;) {
            changed = false;
            for (const patch::PatchWire& wire : patch_.wires) {
                if (!lacks_.contains(wire.from_node) || lacks_.contains(wire.to_node) || wire.from_port.empty())
                    continue;
                if (!is_needed(wire)) continue;
                lacks_[wire.to_node] = fmt::format("'{}' is not finished", wire.from_node);
                changed = true;
            }
        }
        for (const patch::PatchNode& node : patch_.nodes) {
            const auto found = lacks_.find(node.name);
            const TypePorts* ports = ports_of_type(node.type);
            if (found == lacks_.end()) continue;
            UnfinishedNode made{node.name, node.type, node.group.empty() ? node.rate : node.group,
                                {},        {},        found->second};
            if (ports) made.inputs = ports->inputs, made.outputs = ports->outputs;
            made_.nodes.push_back(std::move(made));
        }
    }

    bool is_needed(const patch::PatchWire& wire) const {
        const auto node = nodes_.find(wire.to_node);
        if (node == nodes_.end()) return false;
        const TypePorts* ports = ports_of_type(node->second->type);
        // A sub-patch needs all that it is fed.
        if (!ports) return patch::is_sub_patch(*node->second);
        const auto input = std::ranges::find(ports->inputs, wire.to_port, &PicturePort::name);
        return input != ports->inputs.end() && !input->is_optional && !input->takes_many;
    }

    const PicturePort* port(const std::string& node, const std::string& name, bool is_input) const {
        const auto found = nodes_.find(node);
        const TypePorts* ports = found == nodes_.end() ? nullptr : ports_of_type(found->second->type);
        if (!ports) return nullptr;
        const auto& all = is_input ? ports->inputs : ports->outputs;
        const auto here = std::ranges::find(all, name, &PicturePort::name);
        return here == all.end() ? nullptr : &*here;
    }

    void check(const patch::PatchWire& wire) {
        for (const std::string* name : {&wire.to_node, wire.from_port.empty() ? nullptr : &wire.from_node})
            if (name && !nodes_.contains(*name)) return problems_.add(wire.where, fmt::format("no node '{}'", *name));
        const PicturePort *from = port(wire.from_node, wire.from_port, false),
                          *to = port(wire.to_node, wire.to_port, true);
        const bool is_known = ports_of_type(nodes_.at(wire.to_node)->type) != nullptr;
        if (!wire.from_port.empty() && !from && ports_of_type(nodes_.at(wire.from_node)->type))
            return problems_.add(wire.where,
                                 fmt::format("no output '{}' on node '{}'", wire.from_port, wire.from_node));
        if (is_known && !to) {
            const auto& params = ports_of_type(nodes_.at(wire.to_node)->type)->params;
            const bool drives =
                std::ranges::find(params, wire.to_port, &std::pair<std::string, std::string>::first) != params.end();
            if (!drives)
                return problems_.add(wire.where, fmt::format("no input '{}' on node '{}'", wire.to_port, wire.to_node));
            if (from && from->type && from->type != &value::number)
                return problems_.add(
                    wire.where, fmt::format("'{}.{}' gives {}, but the parameter '{}' takes a number", wire.from_node,
                                            wire.from_port, value::with_article(*from->type), wire.to_port));
        }
        if (from && to && from->type && to->type && from->type != to->type)
            return problems_.add(wire.where, fmt::format("'{}.{}' gives {}, but '{}.{}' takes {}", wire.from_node,
                                                         wire.from_port, value::with_article(*from->type), wire.to_node,
                                                         wire.to_port, value::with_article(*to->type)));
        if ((!to || !to->takes_many) && !fed_.insert(wire.to_node + "." + wire.to_port).second)
            problems_.add(wire.where, fmt::format("input '{}' of node '{}' is already fed by another wire",
                                                  wire.to_port, wire.to_node));
    }

    const patch::Patch& patch_;
    patch::Problems& problems_;
    Nodes nodes_;
    std::map<std::string, std::string> lacks_;
    std::set<std::string> fed_;
    Unfinished made_;
};

}  // namespace

const TypePorts* ports_of_type(std::string_view name) {
    static std::map<std::string, TypePorts, std::less<>> known;
    if (const auto found = known.find(name); found != known.end()) return &found->second;
    const auto catalogue = nodes::catalogue();
    const auto type = std::ranges::find(catalogue, name, [](const NodeType* t) -> std::string_view { return t->name; });
    if (type == catalogue.end()) return nullptr;
    const compile::NodeInstance fresh((*type)->create(), (*type)->destroy);
    PortLister lister;
    (*type)->visit(fresh.get(), lister);
    return &known.emplace(std::string(name), std::move(lister.ports)).first->second;
}

const UnfinishedNode* Unfinished::find(std::string_view name) const {
    const auto found = std::ranges::find(nodes, name, &UnfinishedNode::name);
    return found == nodes.end() ? nullptr : &*found;
}

std::vector<std::string> Unfinished::names() const {
    std::vector<std::string> all;
    for (const UnfinishedNode& node : nodes) all.push_back(node.name);
    return all;
}

Unfinished unfinished_of(const patch::Patch& patch, patch::Problems& problems) {
    return Finder(patch, problems).find();
}

}  // namespace tactus::view

// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/unfinished.hpp"

#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

namespace tactus::window {

namespace {

template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items) {
    std::vector<std::string> names;
    for (const Item& item : items) names.push_back(item.name);
    return names;
}

using Nodes = std::unordered_map<std::string_view, const patch::PatchNode*>;

/// A file that a node lacks; empty: none.
std::string lacking_file(const patch::PatchNode& node, const TypePorts& ports) {
    for (const std::string& asset : ports.assets)
        if (std::ranges::find(node.settings, asset, &OptionText::name) == node.settings.end())
            return fmt::format("'{}' needs a file", asset);
    return {};
}

class Finder {
public:
    Finder(const patch::Patch& patch, patch::Problems& problems, const std::map<std::string, std::string>& at_fault)
        : patch_(patch), problems_(problems), at_fault_(at_fault) {
        for (const patch::PatchNode& node : patch.nodes) nodes_.emplace(node.name, &node);
        made_.parts = part_ports_of(patch);
    }

    Unfinished find() {
        find_nodes();
        if (made_.nodes.empty()) return std::move(made_);
        for (const patch::PatchWire& wire : patch_.wires)
            if (lacks_.contains(wire.from_node) || lacks_.contains(wire.to_node)) {
                check(wire);
                made_.wires.push_back(wire);
            }
        return std::move(made_);
    }

private:
    const TypePorts* ports_of(const patch::PatchNode& node) const {
        if (!patch::is_sub_patch(node)) return ports_of_type(node.type);
        const auto part = made_.parts.find(node.type);
        return part == made_.parts.end() ? nullptr : &part->second.ports;
    }
    const TypePorts* ports_of(const std::string& node) const {
        const auto found = nodes_.find(node);
        return found == nodes_.end() ? nullptr : ports_of(*found->second);
    }

    void find_nodes() {
        // Wires to each input whose source is finished.
        std::unordered_map<std::string, int> fed;
        std::unordered_multimap<std::string_view, const patch::PatchWire*> from;
        for (const patch::PatchWire& wire : patch_.wires) {
            ++fed[wire.to_node + "." + wire.to_port];
            if (!wire.from_port.empty()) from.emplace(wire.from_node, &wire);
        }
        std::vector<std::string> next;
        const auto lack = [&](const std::string& node, std::string what) {
            if (lacks_.emplace(node, std::move(what)).second) next.push_back(node);
        };
        for (const patch::PatchNode& node : patch_.nodes) {
            if (const auto fault = at_fault_.find(node.name); fault != at_fault_.end()) lack(node.name, fault->second);
            const TypePorts* ports = ports_of(node);
            if (!ports) continue;
            for (const PicturePort& port : ports->inputs)
                if (!port.is_optional && !fed.contains(node.name + "." + port.name)) {
                    lack(node.name, fmt::format("input '{}' has no wire", port.name));
                    break;
                }
            if (std::string file = lacking_file(node, *ports); !file.empty()) lack(node.name, std::move(file));
        }
        // An input that only unfinished nodes feed has nothing, unless it can do without.
        for (std::size_t i = 0; i < next.size(); ++i) {
            const std::string source = next[i];
            const auto [first, last] = from.equal_range(source);
            for (auto wire = first; wire != last; ++wire) {
                const patch::PatchWire& led = *wire->second;
                if (--fed[led.to_node + "." + led.to_port] == 0 && is_needed(led))
                    lack(led.to_node, fmt::format("'{}' is not finished", source));
            }
        }
        for (const patch::PatchNode& node : patch_.nodes) {
            const auto found = lacks_.find(node.name);
            if (found == lacks_.end()) continue;
            UnfinishedNode made{node.name,
                                node.type,
                                node.group.empty() ? node.rate : node.group,
                                {},
                                {},
                                found->second,
                                at_fault_.contains(node.name)};
            if (const auto part = made_.parts.find(node.type); made.lane.empty() && part != made_.parts.end())
                made.lane = part->second.lane;
            if (const TypePorts* ports = ports_of(node)) made.inputs = ports->inputs, made.outputs = ports->outputs;
            made_.nodes.push_back(std::move(made));
        }
    }

    bool is_needed(const patch::PatchWire& wire) const {
        const TypePorts* ports = ports_of(wire.to_node);
        if (!ports) return false;
        const auto input = std::ranges::find(ports->inputs, wire.to_port, &PicturePort::name);
        return input != ports->inputs.end() && !input->is_optional;
    }

    const PicturePort* port(const std::string& node, const std::string& name, bool is_input) const {
        const TypePorts* ports = ports_of(node);
        if (!ports) return nullptr;
        const auto& all = is_input ? ports->inputs : ports->outputs;
        const auto here = std::ranges::find(all, name, &PicturePort::name);
        return here == all.end() ? nullptr : &*here;
    }

    void check(const patch::PatchWire& wire) {
        for (const std::string* name : {&wire.to_node, wire.from_port.empty() ? nullptr : &wire.from_node})
            if (name && !nodes_.contains(*name))
                return problems_.add(wire.where,
                                     fmt::format("no node '{}'{}", *name, did_you_mean(*name, names_of(patch_.nodes))));
        const PicturePort *from = port(wire.from_node, wire.from_port, false),
                          *to = port(wire.to_node, wire.to_port, true);
        const TypePorts* target = ports_of(wire.to_node);
        if (!wire.from_port.empty() && !from && ports_of(wire.from_node))
            return problems_.add(
                wire.where, fmt::format("no output '{}' on node '{}'{}", wire.from_port, wire.from_node,
                                        did_you_mean(wire.from_port, names_of(ports_of(wire.from_node)->outputs))));
        if (target && !to) {
            const auto& params = target->params;
            const bool drives =
                std::ranges::find(params, wire.to_port, &std::pair<std::string, std::string>::first) != params.end();
            if (!drives)
                return problems_.add(wire.where, fmt::format("no input '{}' on node '{}'{}", wire.to_port, wire.to_node,
                                                             did_you_mean(wire.to_port, names_of(target->inputs))));
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
    const std::map<std::string, std::string>& at_fault_;
    Nodes nodes_;
    std::map<std::string, std::string> lacks_;
    std::set<std::string> fed_;
    Unfinished made_;
};

}  // namespace

const UnfinishedNode* Unfinished::find(std::string_view name) const {
    const auto found = std::ranges::find(nodes, name, &UnfinishedNode::name);
    return found == nodes.end() ? nullptr : &*found;
}

std::vector<std::string> Unfinished::names() const {
    std::vector<std::string> all;
    for (const UnfinishedNode& node : nodes) all.push_back(node.name);
    return all;
}

Unfinished unfinished_of(const patch::Patch& patch, patch::Problems& problems,
                         const std::map<std::string, std::string>& at_fault) {
    return Finder(patch, problems, at_fault).find();
}

}  // namespace tactus::window

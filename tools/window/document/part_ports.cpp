// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/part_ports.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "graph/patch/sub_patch.hpp"
#include "nodes/catalogue.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace tactus::window {

namespace {

/// A sub-patch as it is read, and as nodes and wires.
struct Part {
    patch::Patch read, flat;
    std::set<std::string> fed;  ///< "node.port" within

    const patch::PatchNode* node(const std::string& name) const {
        const auto found = std::ranges::find(flat.nodes, name, &patch::PatchNode::name);
        return found == flat.nodes.end() ? nullptr : &*found;
    }
    /// The ends within that an end of this name stands for.
    std::vector<const patch::PatchEnd*> ends(const std::string& name) const {
        std::vector<const patch::PatchEnd*> found;
        for (const patch::PatchEnd& end : flat.offered)
            if (end.name == whole_name + name) found.push_back(&end);
        return found;
    }

    static constexpr const char* part_name = "part";
    static inline const std::string whole_name = "part.";
};

std::optional<Part> part_of(const patch::Patch& patch, const std::string& type) {
    Part part;
    part.flat.file = patch.file;
    part.flat.parts = patch.parts;
    patch::PatchNode& node = part.flat.nodes.emplace_back();
    node.name = Part::part_name;
    node.type = type;
    node.rate = "1 kHz";
    patch::read_parts(part.flat);
    const std::string path = patch::part_path("", type);
    const auto text = std::ranges::find(part.flat.parts, path, &patch::PatchPart::path);
    if (text == part.flat.parts.end()) return std::nullopt;
    patch::Problems ignored;
    part.read = patch::read_patch(text->text, patch::file_of_part(part.flat, path), ignored);
    if (!ignored.empty()) return std::nullopt;
    patch::flatten(part.flat, ignored);
    for (const patch::PatchWire& wire : part.flat.wires) part.fed.insert(wire.to_node + "." + wire.to_port);
    return part;
}

std::vector<std::string> names_of(const std::vector<patch::PatchEnd>& ends) {
    std::vector<std::string> names;
    for (const patch::PatchEnd& end : ends)
        if (std::ranges::find(names, end.name) == names.end()) names.push_back(end.name);
    return names;
}

/// The port of a node within that an end stands for; null: it is none.
const PicturePort* port_within(const Part& part, const patch::PatchEnd& end, bool is_input) {
    const patch::PatchNode* node = part.node(end.node);
    const TypePorts* ports = node ? ports_of_type(node->type) : nullptr;
    if (!ports) return nullptr;
    const auto& all = is_input ? ports->inputs : ports->outputs;
    const auto found = std::ranges::find(all, end.port, &PicturePort::name);
    return found == all.end() ? nullptr : &*found;
}

PartPorts ports_of(const Part& part) {
    PartPorts made;
    for (const bool is_input : {true, false})
        for (const std::string& name : names_of(is_input ? part.read.inputs : part.read.outputs)) {
            std::optional<PicturePort> offered;
            for (const patch::PatchEnd* end : part.ends(name)) {
                const PicturePort* port = port_within(part, *end, is_input);
                if (!port) continue;
                const bool does_without =
                    !is_input || port->is_optional || part.fed.contains(end->node + "." + end->port);
                if (!offered) {
                    offered = *port;
                    offered->name = name;
                    offered->is_optional = true;
                }
                offered->is_optional = offered->is_optional && does_without;
                offered->takes_many = offered->takes_many && port->takes_many;
            }
            if (offered) (is_input ? made.ports.inputs : made.ports.outputs).push_back(std::move(*offered));
        }
    for (const std::string& name : names_of(part.read.parameters))
        for (const patch::PatchEnd* end : part.ends(name)) {
            const patch::PatchNode* node = part.node(end->node);
            const TypePorts* ports = node ? ports_of_type(node->type) : nullptr;
            if (!ports) continue;
            const auto param = std::ranges::find(ports->params, end->port, &std::pair<std::string, std::string>::first);
            if (param == ports->params.end()) continue;
            made.ports.params.emplace_back(name, param->second);
            break;
        }
    const auto is_outer = [](const patch::PatchNode& node) { return node.rate == patch::outer_rate; };
    made.takes_rate = std::ranges::any_of(part.read.nodes, is_outer);
    if (made.takes_rate || part.flat.nodes.empty()) return made;
    const patch::PatchNode& first = part.flat.nodes.front();
    made.lane = first.group.empty() ? first.rate : first.group;
    const auto group = std::ranges::find(part.flat.groups, first.group, &patch::PatchGroup::name);
    if (group != part.flat.groups.end()) made.lane = group->rate;
    return made;
}

}  // namespace

std::map<std::string, PartPorts> part_ports_of(const patch::Patch& patch) {
    std::map<std::string, PartPorts> all;
    for (const patch::PatchNode& node : patch.nodes)
        if (patch::is_sub_patch(node) && !all.contains(node.type))
            if (const auto part = part_of(patch, node.type)) all.emplace(node.type, ports_of(*part));
    return all;
}

std::vector<ParameterField> parameters_of_part(const patch::Patch& patch, const patch::PatchNode& node) {
    std::vector<ParameterField> fields;
    const auto part = part_of(patch, node.type);
    if (!part) return fields;
    const auto catalogue = nodes::catalogue();
    for (const std::string& name : names_of(part->read.parameters))
        for (const patch::PatchEnd* end : part->ends(name)) {
            const patch::PatchNode* inner = part->node(end->node);
            const auto type = std::ranges::find(catalogue, inner ? inner->type : "",
                                                [](const NodeType* t) -> std::string { return t->name; });
            if (type == catalogue.end()) continue;
            const std::vector<ParameterField> all = parameters_of(**type, part->flat, *inner);
            const auto found = std::ranges::find(all, end->port, &ParameterField::name);
            if (found == all.end()) continue;
            // Its default is what its own file says.
            ParameterField field = *found;
            field.name = name;
            field.standard = field.text;
            field.normal = field.value;
            field.is_set = false;
            take_setting(field, node);
            field.is_driven = std::ranges::any_of(patch.wires, [&](const patch::PatchWire& wire) {
                return wire.to_node == node.name && wire.to_port == name;
            });
            fields.push_back(std::move(field));
            break;
        }
    return fields;
}

}  // namespace tactus::window

// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tactus::compile {

namespace {

template <class Port>
std::vector<std::string> names_of(const std::vector<Port>& ports) {
    std::vector<std::string> names;
    for (const Port& port : ports) names.push_back(port.name);
    return names;
}

template <class Port>
int index_of(const std::vector<Port>& ports, const std::string& name) {
    const auto found = std::ranges::find(ports, name, &Port::name);
    return found == ports.end() ? -1 : static_cast<int>(found - ports.begin());
}

std::string no_port(const ScheduleNode& node, const std::string& port, const std::vector<std::string>& candidates) {
    return fmt::format("no port '{}' on node '{}'{}", port, node.name, did_you_mean(port, candidates));
}

/// Lookup tables shared by all wires.
struct WireContext {
    explicit WireContext(const Schedule& plan, const patch::Problems& problems_) : problems(problems_) {
        for (const ScheduleNode& node : plan.nodes) nodes.emplace(node.name, static_cast<int>(nodes.size()));
        for (const patch::PatchAsset& asset : plan.patch.assets) assets.insert(asset.name);
    }

    /// The name among those of `items` that was meant.
    template <class Item>
    std::string hint(const std::string& name, const std::vector<Item>& items) const {
        return problems.wants_hint() ? did_you_mean(name, names_of(items)) : "";
    }

    const patch::Problems& problems;
    std::map<std::string_view, int> nodes;
    std::unordered_set<std::string_view> assets;
    std::unordered_set<const Param*> driven;  ///< parameters that wires drive so far
    std::set<std::tuple<const Output*, const Input*, int>> event_wires;  ///< so far: from, to, delay
};

using value::with_article;

/// Both ends of one wire found, or what is wrong with it.
class WireResolver {
public:
    WireResolver(Schedule& plan, WireContext& context, const patch::PatchWire& source)
        : plan_(plan), context_(context), source_(source) {}

    ScheduleWire resolve() {
        wire_.mode = source_.mode;
        wire_.delay = source_.delay;
        wire_.where = source_.where;
        find_source();
        find_target();
        if (wire_.to_input >= 0) check_input();
        else check_param();
        return std::move(wire_);
    }

    /// True if the only fault is that the type of the wire is undetermined; another error may be its cause.
    bool is_undecided() const { return is_undecided_; }

    /// The input that the wire names, or null. A faulty wire counts as connected, so that one mistake gives one error.
    Input* meant_input() {
        const auto found = context_.nodes.find(source_.to_node);
        if (found == context_.nodes.end()) return nullptr;
        auto& inputs = node(found->second).inputs;
        const int input = index_of(inputs, source_.to_port);
        return input < 0 ? nullptr : inputs[static_cast<std::size_t>(input)].port;
    }

private:
    ScheduleNode& node(int index) { return plan_.nodes[static_cast<std::size_t>(index)]; }

    int find_node(const std::string& name) {
        const auto found = context_.nodes.find(name);
        if (found == context_.nodes.end())
            throw Error(fmt::format("no node '{}'{}", name, context_.hint(name, plan_.nodes)));
        return found->second;
    }

    void find_source() {
        if (source_.from_port.empty()) {
            if (!context_.assets.contains(source_.from_node))
                throw Error(fmt::format("no asset '{}' in [assets]{}; a node needs a port, as in '{}.port'",
                                        source_.from_node, context_.hint(source_.from_node, plan_.patch.assets),
                                        source_.from_node));
            wire_.asset = source_.from_node;
            return;
        }
        wire_.from_node = find_node(source_.from_node);
        ScheduleNode& from = node(wire_.from_node);
        wire_.from_output = index_of(from.outputs, source_.from_port);
        if (wire_.from_output >= 0) return;
        if (index_of(from.inputs, source_.from_port) >= 0)
            throw Error(
                fmt::format("'{}' is an input of node '{}'; a wire starts at an output", source_.from_port, from.name));
        throw Error(no_port(from, source_.from_port, names_of(from.outputs)));
    }

    void find_target() {
        wire_.to_node = find_node(source_.to_node);
        ScheduleNode& to = node(wire_.to_node);
        wire_.to_input = index_of(to.inputs, source_.to_port);
        if (wire_.to_input >= 0) return;
        if (const auto param = to.params.find(source_.to_port); param != to.params.end()) {
            wire_.param = param->second;
            return;
        }
        if (index_of(to.outputs, source_.to_port) >= 0)
            throw Error(
                fmt::format("'{}' is an output of node '{}'; a wire ends at an input", source_.to_port, to.name));
        std::vector<std::string> candidates = names_of(to.inputs);
        for (const auto& [name, param] : to.params) candidates.push_back(name);
        throw Error(no_port(to, source_.to_port, candidates));
    }

    const ValueType& source_type() {
        return *node(wire_.from_node).outputs[static_cast<std::size_t>(wire_.from_output)].port->type;
    }
    bool crosses() { return wire_.from_node >= 0 && node(wire_.from_node).group != node(wire_.to_node).group; }

    void check_input() {
        ScheduleInput& target = node(wire_.to_node).inputs[static_cast<std::size_t>(wire_.to_input)];
        Input& port = *target.port;
        if (port.connected && port.kind != InputKind::events)
            throw Error(fmt::format("input '{}' of node '{}' is already fed by another wire", target.name,
                                    node(wire_.to_node).name));
        port.connected = true;
        target.where = source_.where;
        if (wire_.from_node < 0) {
            if (port.kind != InputKind::value || !port.type->version)
                throw Error(fmt::format("asset '{}' cannot feed '{}', which takes a {}", wire_.asset, target.name,
                                        port.type ? port.type->name : "value"));
            if (source_.mode_given)
                throw Error(fmt::format("asset '{}' is constant; leave out how it is delivered", wire_.asset));
            if (!port.type->load_asset)
                throw Error(fmt::format("no file holds a {} for input '{}'", port.type->name, target.name));
            return;
        }
        const ValueType& type = source_type();
        if (port.kind == InputKind::any) take_type(port, type);
        if (*port.type != type)
            throw Error(fmt::format("'{}.{}' gives {}, but '{}.{}' takes {}{}", source_.from_node, source_.from_port,
                                    with_article(type), source_.to_node, source_.to_port, with_article(*port.type),
                                    port.type->name == type.name
                                        ? " of another layout; build the plug-ins that share it "
                                          "from one header"
                                        : ""));
        if (port.kind == InputKind::events) return check_events(port);
        check_mode(port, type);
        port.period = plan_.groups[static_cast<std::size_t>(node(wire_.from_node).group)].period;
    }

    void take_type(Input& port, const ValueType& type) {
        is_undecided_ = &type == &value::undecided;
        if (is_undecided_)
            throw Error(fmt::format("the type of '{}.{}' is not known: feed an input of '{}' by a node of known type",
                                    source_.from_node, source_.from_port, source_.from_node));
        if (!(port.takes & kind_of(type)))
            throw Error(fmt::format("'{}.{}' gives {}, but '{}.{}' takes a {}", source_.from_node, source_.from_port,
                                    with_article(type), source_.to_node, source_.to_port, type_names(port.takes)));
        if (!port.type) port.type = &type;
    }

    void check_mode(const Input& port, const ValueType& type) {
        if (port.kind == InputKind::batch && wire_.mode != patch::WireMode::batch)
            throw Error(
                fmt::format("input '{}' takes every value since its last tick; write 'as batch'", source_.to_port));
        if (port.kind != InputKind::batch && wire_.mode == patch::WireMode::batch)
            throw Error(fmt::format("input '{}' takes one value; 'as batch' is not for it", source_.to_port));
        if (wire_.mode == patch::WireMode::linear && !type.interpolate)
            throw Error(fmt::format("a {} cannot be interpolated; leave 'as linear' out", type.name));
        if (crosses() && &type == &value::signal && port.kind != InputKind::batch)
            throw Error(fmt::format("a signal stays in its group; give '{}' and '{}' one group, or take it 'as batch'",
                                    source_.from_node, source_.to_node));
    }

    /// Any number of wires may bring events, each in the tick it is for.
    void check_events(const Input& port) {
        using patch::WireMode;
        const bool is_held = wire_.mode == WireMode::hold || wire_.mode == WireMode::linear;
        if (source_.mode_given && is_held)
            throw Error(fmt::format("events are never held or interpolated; leave 'as {}' out",
                                    wire_.mode == WireMode::hold ? "hold" : "linear"));
        if (is_held) wire_.mode = WireMode::batch;
        const ScheduleNode& from = node(wire_.from_node);
        const ScheduleGroup& group = plan_.groups[static_cast<std::size_t>(from.group)];
        const std::int64_t waiting = crosses() ? wire_latency(group, wire_) / group.period : wire_.delay;
        const Flicks reading = plan_.groups[static_cast<std::size_t>(node(wire_.to_node).group)].period;
        if (reading / group.period > max_at_once)
            throw Error(fmt::format("'{}' runs once in {} ticks of '{}', and {} is the most for events",
                                    source_.to_node, reading / group.period, source_.from_node, max_at_once));
        if (waiting > max_waiting)
            throw Error(
                fmt::format("events would wait for {} ticks on this wire, and {} is the most; event_delay "
                            "delays them by any time",
                            waiting, max_waiting));
        const Output* const output = from.outputs[static_cast<std::size_t>(wire_.from_output)].port;
        if (!context_.event_wires.emplace(output, &port, wire_.delay).second)
            throw Error(fmt::format("'{}.{}' is already wired to '{}.{}'; every event would come twice",
                                    source_.from_node, source_.from_port, source_.to_node, source_.to_port));
    }

    void check_param() {
        if (wire_.from_node < 0) throw Error(fmt::format("asset '{}' cannot drive a parameter", wire_.asset));
        if (&source_type() != &value::number)
            throw Error(fmt::format("'{}.{}' gives {}, but the parameter '{}' takes a number", source_.from_node,
                                    source_.from_port, with_article(source_type()), source_.to_port));
        if (wire_.param->is_structural)
            throw Error(fmt::format("parameter '{}' of node '{}' is structural and cannot change while the patch runs",
                                    source_.to_port, source_.to_node));
        if (wire_.mode == patch::WireMode::batch) throw Error("a parameter takes one value; 'as batch' is not for it");
        if (!context_.driven.insert(wire_.param).second)
            throw Error(fmt::format("parameter '{}' of node '{}' is already driven by another wire", source_.to_port,
                                    source_.to_node));
    }

    static constexpr std::int64_t max_waiting = 10'000, max_at_once = 50'000;  // a tick's events take 776 bytes

    Schedule& plan_;
    WireContext& context_;
    const patch::PatchWire& source_;
    ScheduleWire wire_;
    bool is_undecided_ = false;
};

void check_unconnected(const ScheduleNode& node, patch::Problems& problems) {
    for (const ScheduleInput& input : node.inputs)
        if (!input.port->connected && !input.port->is_optional)
            problems.add(node.where, fmt::format("input '{}' of node '{}' is not connected ({})", input.name, node.name,
                                                 input.port->about));
}

bool carries_stream(const ScheduleNode& node) {
    const auto stream_input = [](const ScheduleInput& i) {
        return i.port->kind == InputKind::stream || (i.port->kind == InputKind::any && i.port->type == &value::signal);
    };
    return std::ranges::any_of(node.inputs, stream_input) ||
           std::ranges::any_of(node.outputs, [](const ScheduleOutput& o) { return o.port->type == &value::signal; });
}

}  // namespace

void resolve_wires(Schedule& plan, patch::Problems& problems) {
    // Wires can only be checked if every node was made.
    for (const ScheduleNode& node : plan.nodes)
        if (!node.type || node.group < 0) return;
    WireContext context(plan, problems);
    plan.wires.reserve(plan.patch.wires.size());
    const std::size_t known = problems.list.size();
    std::vector<std::pair<SourceLocation, std::string>> undecided;
    for (const patch::PatchWire& source : plan.patch.wires) {
        WireResolver resolver(plan, context, source);
        try {
            plan.wires.push_back(resolver.resolve());
        } catch (const Error& error) {
            if (resolver.is_undecided()) undecided.emplace_back(source.where, error.message());
            else problems.add(source.where, error.message());
            if (Input* meant = resolver.meant_input()) meant->connected = true;
        }
    }
    if (problems.list.size() == known)
        for (const auto& [where, message] : undecided) problems.add(where, message);
    const bool wires_are_sound = problems.list.size() == known;
    for (ScheduleNode& node : plan.nodes) {
        // A faulty wire leaves its input open; report only the wire.
        if (wires_are_sound) check_unconnected(node, problems);
        node.takes_blocks = carries_stream(node);
        if (node.takes_blocks) plan.groups[static_cast<std::size_t>(node.group)].has_audio = true;
    }
}

}  // namespace tactus::compile

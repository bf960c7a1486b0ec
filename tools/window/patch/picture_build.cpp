// SPDX-License-Identifier: Apache-2.0
// The picture of a patch: nodes of its plan, closed sub-patches, and nodes that are not finished.
#include "tools/window/document/unfinished.hpp"
#include "tools/window/patch/picture_arrange.hpp"

#include "dsp/core/units.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace tactus::window {

namespace {

class Builder {
public:
    explicit Builder(const PictureMatter& matter) : matter_(matter) {}

    PatchPicture build() {
        if (matter_.plan) {
            add_lanes();
            add_nodes();
            add_wires();
        }
        if (matter_.unfinished) add_unfinished();
        if (matter_.window) dress();
        arrange(picture_, orders_, matter_.window);
        add_frames();
        return std::move(picture_);
    }

private:
    /// The closed sub-patch that a node of the plan stands in; empty: none.
    std::string part_of(const std::string& node) const {
        const std::size_t end = node.find(patch::within_node);
        if (end == std::string::npos) return {};
        const std::string part = node.substr(0, end);
        const bool is_known =
            std::ranges::find(matter_.parts, part, &std::pair<std::string, std::string>::first) != matter_.parts.end();
        const bool is_open =
            !matter_.window || std::ranges::find(matter_.window->open, part) != matter_.window->open.end();
        return is_known && !is_open ? part : std::string();
    }

    void add_lanes() {
        for (const compile::ScheduleGroup& group : matter_.plan->groups) {
            const std::string rate =
                format_quantity(rate_of(group.period), rate_of(group.period) >= 1000.0 ? "kHz" : "Hz");
            picture_.lanes.push_back({group.name,
                                      fmt::format("{}latency {:.4g} ms", group.name == rate ? "" : rate + ", ",
                                                  seconds(group.latency) * 1e3),
                                      0.0, 0.0});
        }
        orders_.resize(picture_.lanes.size());
    }

    void add_nodes() {
        const compile::Schedule& plan = *matter_.plan;
        index_.assign(plan.nodes.size(), -1);
        std::map<std::string, int> parts;
        for (std::size_t n = 0; n < plan.nodes.size(); ++n)
            if (part_of(plan.nodes[n].name).empty()) index_[n] = add_node(plan.nodes[n], static_cast<int>(n));
        for (const compile::ScheduleGroup& group : plan.groups)
            for (const int node : group.order) {
                const auto n = static_cast<std::size_t>(node);
                const std::string part = part_of(plan.nodes[n].name);
                if (!part.empty()) {
                    if (const auto known = parts.find(part); known != parts.end()) {
                        index_[n] = known->second;
                        continue;
                    }
                    index_[n] = parts[part] = add_part(part, plan.nodes[n].group);
                }
                orders_[static_cast<std::size_t>(plan.nodes[n].group)].push_back(index_[n]);
            }
    }

    int add_node(const compile::ScheduleNode& node, int index) {
        PictureNode& made = picture_.nodes.emplace_back();
        made.name = node.name;
        made.type = node.type ? node.type->name : "";
        made.group = node.group;
        made.plan = index;
        for (const compile::ScheduleInput& input : node.inputs) {
            PicturePort& port = made.inputs.emplace_back(PicturePort{input.name,
                                                                     std::string(input.port->about),
                                                                     std::string(input.port->unit),
                                                                     input.port->type,
                                                                     input.port->is_optional,
                                                                     false,
                                                                     false,
                                                                     {}});
            port.takes_many = input.port->kind == InputKind::events;
        }
        for (const compile::ScheduleOutput& output : node.outputs)
            made.outputs.push_back({output.name,
                                    std::string(output.port->about),
                                    std::string(output.port->unit),
                                    output.port->type,
                                    true,
                                    false,
                                    false,
                                    {}});
        return static_cast<int>(picture_.nodes.size()) - 1;
    }

    /// A closed sub-patch, with the ends that it offers.
    int add_part(const std::string& part, int group) {
        PictureNode made;
        made.name = part;
        made.type = std::ranges::find(matter_.parts, part, &std::pair<std::string, std::string>::first)->second;
        made.group = group;
        made.is_part = true;
        for (const patch::PatchEnd& end : matter_.plan->patch.offered) {
            if (!end.name.starts_with(part + ".")) continue;
            const std::string name = end.name.substr(part.size() + 1);
            const auto node = std::ranges::find(matter_.plan->nodes, end.node, &compile::ScheduleNode::name);
            if (node == matter_.plan->nodes.end()) continue;
            const auto output = std::ranges::find(node->outputs, end.port, &compile::ScheduleOutput::name);
            const auto input = std::ranges::find(node->inputs, end.port, &compile::ScheduleInput::name);
            const auto known = [&](const std::vector<PicturePort>& ports) {
                return std::ranges::find(ports, name, &PicturePort::name) != ports.end();
            };
            if (output != node->outputs.end() && !known(made.outputs))
                made.outputs.push_back({name,
                                        std::string(output->port->about),
                                        std::string(output->port->unit),
                                        output->port->type,
                                        true,
                                        false,
                                        false,
                                        {}});
            else if (input != node->inputs.end() && !known(made.inputs)) {
                made.inputs.push_back({name,
                                       std::string(input->port->about),
                                       std::string(input->port->unit),
                                       input->port->type,
                                       input->port->is_optional,
                                       false,
                                       false,
                                       {}});
                made.inputs.back().takes_many = input->port->kind == InputKind::events;
            }
        }
        picture_.nodes.push_back(std::move(made));
        return static_cast<int>(picture_.nodes.size()) - 1;
    }

    /// The name of an end of a node in the picture: that of the sub-patch, when the node stands in a closed one.
    std::string shown_name(std::size_t plan_node, const std::string& port) const {
        const compile::ScheduleNode& node = matter_.plan->nodes[plan_node];
        const PictureNode& shown = picture_.nodes[static_cast<std::size_t>(index_[plan_node])];
        if (!shown.is_part) return port;
        for (const patch::PatchEnd& end : matter_.plan->patch.offered)
            if (end.node == node.name && end.port == port && end.name.starts_with(shown.name + "."))
                return end.name.substr(shown.name.size() + 1);
        return port;
    }

    static int port_named(std::vector<PicturePort>& ports, const std::string& name, const PicturePort& otherwise) {
        const auto found = std::ranges::find(ports, name, &PicturePort::name);
        if (found != ports.end()) return static_cast<int>(found - ports.begin());
        ports.push_back(otherwise);
        ports.back().name = name;
        return static_cast<int>(ports.size()) - 1;
    }

    /// A port of a closed sub-patch that shows because a wire ends there.
    static PicturePort wired_port(const auto& end) {
        return {end.name, std::string(end.port->about), std::string(end.port->unit), end.port->type, true, true, false,
                {}};
    }

    void add_wires() {
        const compile::Schedule& plan = *matter_.plan;
        for (const compile::ScheduleWire& wire : plan.wires) {
            const auto to = static_cast<std::size_t>(wire.to_node);
            const compile::ScheduleNode& target = plan.nodes[to];
            const int shown_to = index_[to];
            const bool is_within = wire.from_node >= 0 &&
                                   index_[static_cast<std::size_t>(wire.from_node)] == shown_to &&
                                   picture_.nodes[static_cast<std::size_t>(shown_to)].is_part;
            if (is_within) continue;
            auto& inputs = picture_.nodes[static_cast<std::size_t>(shown_to)].inputs;
            int input = wire.to_input;
            if (wire.to_input < 0) {
                std::string name;
                for (const auto& [known, param] : target.params)
                    if (param == wire.param) name = known;
                input = port_named(
                    inputs, shown_name(to, name),
                    {name, std::string(wire.param->about), wire.param->unit, &value::number, true, true, true, {}});
            } else if (picture_.nodes[static_cast<std::size_t>(shown_to)].is_part) {
                const compile::ScheduleInput& end = target.inputs[static_cast<std::size_t>(wire.to_input)];
                input = port_named(inputs, shown_name(to, end.name), wired_port(end));
            }
            inputs[static_cast<std::size_t>(input)].is_connected = true;
            if (wire.from_node < 0) continue;
            const auto from = static_cast<std::size_t>(wire.from_node);
            const compile::ScheduleNode& source = plan.nodes[from];
            PictureNode& shown_from = picture_.nodes[static_cast<std::size_t>(index_[from])];
            int output = wire.from_output;
            if (shown_from.is_part) {
                const compile::ScheduleOutput& end = source.outputs[static_cast<std::size_t>(wire.from_output)];
                output = port_named(shown_from.outputs, shown_name(from, end.name), wired_port(end));
            }
            shown_from.outputs[static_cast<std::size_t>(output)].is_connected = true;
            const compile::ScheduleGroup& group = plan.groups[static_cast<std::size_t>(source.group)];
            const bool crosses = source.group != target.group;
            add_wire(index_[from], output, shown_to, input, wire.mode,
                     crosses ? compile::wire_latency(group, wire) : wire.delay * group.period, crosses);
        }
    }

    void add_wire(int from, int output, int to, int input, patch::WireMode mode, Flicks latency, bool crosses) {
        const auto is_part = [&](int node) { return picture_.nodes[static_cast<std::size_t>(node)].is_part; };
        // One outer wire may feed several nodes of a closed sub-patch.
        if (is_part(to) || is_part(from))
            for (const PictureWire& w : picture_.wires)
                if (w.from == from && w.output == output && w.to == to && w.input == input) return;
        picture_.wires.push_back({from, output, to, input, mode, latency, crosses, {}, {}, {}});
    }

    int lane_named(const std::string& name) {
        const auto found = std::ranges::find(picture_.lanes, name, &PictureLane::name);
        if (found != picture_.lanes.end()) return static_cast<int>(found - picture_.lanes.begin());
        picture_.lanes.push_back({name, "", 0.0, 0.0});
        orders_.emplace_back();
        return static_cast<int>(picture_.lanes.size()) - 1;
    }

    void add_unfinished() {
        for (const UnfinishedNode& node : matter_.unfinished->nodes) {
            PictureNode& made = picture_.nodes.emplace_back();
            made.name = node.name;
            made.type = node.type;
            made.inputs = node.inputs;
            made.outputs = node.outputs;
            made.lacks = node.lacks;
            made.is_at_fault = node.is_at_fault;
            const int lane = lane_named(node.lane);
            made.group = lane;
            orders_[static_cast<std::size_t>(lane)].push_back(static_cast<int>(picture_.nodes.size()) - 1);
        }
        for (const patch::PatchWire& wire : matter_.unfinished->wires) add_written(wire, {});
        for (const BrokenWire& broken : matter_.unfinished->broken) add_written(broken.wire, broken.why);
    }

    /// A wire by the names in the text; a port that the node does not have is shown as well.
    void add_written(const patch::PatchWire& wire, const std::string& fault) {
        const int to = picture_.find(wire.to_node), from = wire.from_port.empty() ? -1 : picture_.find(wire.from_node);
        if (to < 0) return;
        PictureNode& target = picture_.nodes[static_cast<std::size_t>(to)];
        const int input = port_named(target.inputs, wire.to_port, written_port(wire.to_port, &value::number, fault));
        target.inputs[static_cast<std::size_t>(input)].is_connected = true;
        if (from < 0) return;
        PictureNode& source = picture_.nodes[static_cast<std::size_t>(from)];
        const int output = port_named(source.outputs, wire.from_port, written_port(wire.from_port, nullptr, fault));
        source.outputs[static_cast<std::size_t>(output)].is_connected = true;
        add_wire(from, output, to, input, wire.mode, 0, source.group != target.group);
        if (!fault.empty()) picture_.wires.back().fault = fault;
    }

    static PicturePort written_port(const std::string& name, const ValueType* type, const std::string& fault) {
        PicturePort port{name, fault, "", type, true, true, type != nullptr, {}};
        port.is_missing = !fault.empty();
        return port;
    }

    void dress() {
        for (PictureNode& node : picture_.nodes)
            if (const auto colour = matter_.window->colours.find(node.name); colour != matter_.window->colours.end())
                node.colour = colour->second;
        for (const patch::PatchComment& comment : matter_.window->comments)
            picture_.comments.push_back(
                {comment.name,
                 comment.text,
                 comment.colour,
                 {comment.place.x, comment.place.y, comment.place.x + std::max(comment.size.x, 40.0),
                  comment.place.y + std::max(comment.size.y, 24.0)}});
    }

    /// Frames around the nodes of open sub-patches, for each lane.
    void add_frames() {
        std::map<std::pair<std::string, int>, Box> frames;
        for (const PictureNode& node : picture_.nodes) {
            const std::size_t end = node.name.find(patch::within_node);
            if (end == std::string::npos) continue;
            const auto [at, is_new] = frames.emplace(std::pair(node.name.substr(0, end), node.group), node.box);
            Box& box = at->second;
            box = {std::min(box.left, node.box.left), std::min(box.top, node.box.top),
                   std::max(box.right, node.box.right), std::max(box.bottom, node.box.bottom)};
        }
        constexpr double margin = 7.0;
        for (const auto& [key, box] : frames)
            picture_.frames.push_back(
                {key.first, {box.left - margin, box.top - margin, box.right + margin, box.bottom + margin}});
    }

    const PictureMatter& matter_;
    PatchPicture picture_;
    std::vector<int> index_;  // by node of the plan: its node in the picture
    std::vector<std::vector<int>> orders_;  // by lane
};

}  // namespace

PatchPicture picture_of(const PictureMatter& matter) { return Builder(matter).build(); }

PatchPicture picture_of(const compile::Schedule& plan) {
    return picture_of(PictureMatter{&plan, nullptr, nullptr, {}});
}

}  // namespace tactus::window

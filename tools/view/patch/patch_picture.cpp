// SPDX-License-Identifier: Apache-2.0
#include "tools/view/patch/patch_picture.hpp"

#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tactus::view {

namespace {

constexpr double value_room = 60, row_gap = 18, lane_head = 30, lane_padding = 14, lane_gap = 14, left_edge = 40;

void fill_node(const compile::PlanNode& node, PictureNode& made) {
    made.name = node.name;
    made.type = node.type ? node.type->name : "";
    made.group = node.group;
    for (const compile::PlanInput& input : node.inputs)
        made.inputs.push_back({input.name,
                               std::string(input.port->about),
                               std::string(input.port->unit),
                               input.port->type,
                               input.port->is_optional,
                               false,
                               false,
                               {}});
    for (const compile::PlanOutput& output : node.outputs)
        made.outputs.push_back({output.name,
                                std::string(output.port->about),
                                std::string(output.port->unit),
                                output.port->type,
                                true,
                                false,
                                false,
                                {}});
}

/// The target input of a wire; a driven parameter becomes an input.
int input_of(const compile::PlanWire& wire, const compile::PlanNode& node, PictureNode& made) {
    if (wire.to_input >= 0) return wire.to_input;
    for (const auto& [name, param] : node.params) {
        if (param != wire.param) continue;
        const auto known =
            std::ranges::find_if(made.inputs, [&](const auto& p) { return p.is_param && p.name == name; });
        if (known != made.inputs.end()) return static_cast<int>(known - made.inputs.begin());
        made.inputs.push_back({name, std::string(param->about), param->unit, &value::number, true, true, true, {}});
        return static_cast<int>(made.inputs.size()) - 1;
    }
    return 0;
}

/// Longest path from a source within a lane; delay wires are ignored.
std::vector<int> columns_of(const compile::Plan& plan) {
    std::vector<int> columns(plan.nodes.size(), 0);
    std::vector<std::vector<int>> next(plan.nodes.size());
    for (const compile::PlanWire& wire : plan.wires) {
        if (wire.from_node < 0 || wire.mode == patch::WireMode::delay) continue;
        const auto from = static_cast<std::size_t>(wire.from_node), to = static_cast<std::size_t>(wire.to_node);
        if (plan.nodes[from].group == plan.nodes[to].group) next[from].push_back(wire.to_node);
    }
    for (const compile::PlanGroup& group : plan.groups)
        for (const int from : group.order)
            for (const int to : next[static_cast<std::size_t>(from)]) {
                int& column = columns[static_cast<std::size_t>(to)];
                column = std::max(column, columns[static_cast<std::size_t>(from)] + 1);
            }
    return columns;
}

double height_of(const PictureNode& node) {
    const std::size_t rows = std::max<std::size_t>({node.inputs.size(), node.outputs.size(), 1});
    return title_height + static_cast<double>(rows) * port_height + 7.0;
}

/// Longer columns are split side by side, so that a lane of many nodes has the shape of a screen.
int most_rows(std::size_t nodes_of_lane) {
    constexpr double wide = 1.4;  // aspect ratio of a screen, in boxes
    return std::max(24, static_cast<int>(std::ceil(std::sqrt(wide * static_cast<double>(nodes_of_lane)))));
}

class Arrangement {
public:
    Arrangement(const compile::Plan& plan, PatchPicture& picture)
        : plan_(plan), picture_(picture), columns_(columns_of(plan)), depth_(plan.nodes.size()) {}

    void arrange() {
        double top = 0.0;
        for (const compile::PlanGroup& group : plan_.groups) {
            const std::string rate =
                format_quantity(rate_of(group.period), rate_of(group.period) >= 1000.0 ? "kHz" : "Hz");
            PictureLane lane{
                group.name,
                fmt::format("{}latency {:.4g} ms", group.name == rate ? "" : rate + ", ", seconds(group.latency) * 1e3),
                top, 0.0};
            lane.bottom = arrange_lane(group, top + lane_head) + lane_padding;
            top = lane.bottom + lane_gap;
            picture_.lanes.push_back(lane);
        }
        picture_.bounds = {0.0, 0.0, right_ + left_edge + value_room, std::max(top - lane_gap, 1.0)};
    }

private:
    double arrange_lane(const compile::PlanGroup& group, double top) {
        std::map<int, std::vector<int>> by_column;
        for (const int node : group.order) by_column[columns_[static_cast<std::size_t>(node)]].push_back(node);
        double x = left_edge, bottom = top + title_height;
        for (auto& [column, nodes] : by_column) {
            sort_by_sources(nodes);
            double y = top, gone = 0.0;
            int row = 0;
            for (const int index : nodes) {
                PictureNode& node = picture_.nodes[static_cast<std::size_t>(index)];
                if (row == most_rows(group.order.size())) {
                    row = 0;
                    gone += y - top;
                    y = top;
                    x += node_width + row_gap;
                }
                node.box = {x, y, x + node_width, y + height_of(node)};
                depth_[static_cast<std::size_t>(index)] = gone + y;
                if (row == 0) picture_.stacks.push_back(node.box);
                picture_.stacks.back().bottom = node.box.bottom;
                y = node.box.bottom + row_gap;
                bottom = std::max(bottom, node.box.bottom);
                ++row;
            }
            right_ = std::max(right_, x + node_width);
            x += node_width + column_gap;
        }
        return bottom;
    }

    /// Sorts the nodes of a column by their sources, so that fewer wires cross.
    void sort_by_sources(std::vector<int>& nodes) const {
        std::map<int, double> height;
        for (const int node : nodes) {
            double sum = 0.0;
            int count = 0;
            for (const std::size_t w : feeding(node)) {
                const compile::PlanWire& wire = plan_.wires[w];
                const PictureNode& from = picture_.nodes[static_cast<std::size_t>(wire.from_node)];
                if (from.box.width() == 0.0) continue;
                sum += depth_[static_cast<std::size_t>(wire.from_node)] + title_height + wire.from_output * port_height;
                ++count;
            }
            height[node] = count > 0 ? sum / count : 1e9;
        }
        std::ranges::stable_sort(nodes, {}, [&](int node) { return height[node]; });
    }

    const std::vector<std::size_t>& feeding(int node) const {
        if (feeding_.empty()) {
            feeding_.resize(plan_.nodes.size());
            for (std::size_t w = 0; w < plan_.wires.size(); ++w)
                if (plan_.wires[w].from_node >= 0)
                    feeding_[static_cast<std::size_t>(plan_.wires[w].to_node)].push_back(w);
        }
        return feeding_[static_cast<std::size_t>(node)];
    }

    const compile::Plan& plan_;
    PatchPicture& picture_;
    std::vector<int> columns_;
    std::vector<double> depth_;  ///< vertical position of each node without split columns
    mutable std::vector<std::vector<std::size_t>> feeding_;
    double right_ = left_edge + node_width;
};

void place_ports(PictureNode& node) {
    const auto place = [&](std::vector<PicturePort>& ports, double x) {
        for (std::size_t i = 0; i < ports.size(); ++i)
            ports[i].at = {x, node.box.top + title_height + (static_cast<double>(i) + 0.5) * port_height};
    };
    place(node.inputs, node.box.left);
    place(node.outputs, node.box.right);
}

/// Above this number of nodes wires are drawn directly, because routing would take long.
constexpr std::size_t most_routed = 300;

void route_wires(PatchPicture& picture) {
    std::vector<Box> boxes;
    std::vector<double> levels;
    if (picture.nodes.size() <= most_routed) {
        for (const PictureNode& node : picture.nodes) boxes.push_back(node.box);
        for (const PictureLane& lane : picture.lanes) levels.push_back(lane.bottom + 0.5 * lane_gap);
        // No wires run below the picture.
        if (!levels.empty()) levels.back() = picture.lanes.back().bottom - 0.5 * lane_padding;
    }
    WireRouter router(std::move(boxes), levels);
    for (PictureWire& wire : picture.wires) {
        const auto& outputs = picture.nodes[static_cast<std::size_t>(wire.from)].outputs;
        const auto& inputs = picture.nodes[static_cast<std::size_t>(wire.to)].inputs;
        constexpr int most_outputs = 256;
        wire.way = router.way(outputs[static_cast<std::size_t>(wire.output)].at,
                              inputs[static_cast<std::size_t>(wire.input)].at, most_outputs * wire.from + wire.output);
        wire.bounds = bounds_of(wire.way.front());
        for (const BezierCurve& piece : wire.way) {
            const Box box = bounds_of(piece);
            wire.bounds = {std::min(wire.bounds.left, box.left), std::min(wire.bounds.top, box.top),
                           std::max(wire.bounds.right, box.right), std::max(wire.bounds.bottom, box.bottom)};
        }
    }
}

double distance_to(const PictureWire& wire, Point at) {
    double least = 1e300;
    for (const BezierCurve& piece : wire.way) least = std::min(least, distance_to(piece, at));
    return least;
}

}  // namespace

int PatchPicture::find(std::string_view node) const {
    const auto found = std::ranges::find(nodes, node, &PictureNode::name);
    return found == nodes.end() ? -1 : static_cast<int>(found - nodes.begin());
}

Point middle_of(const PictureWire& wire) { return on_curve(wire.way[wire.way.size() / 2], 0.5); }

PatchPicture picture_of(const compile::Plan& plan) {
    PatchPicture picture;
    picture.nodes.resize(plan.nodes.size());
    for (std::size_t n = 0; n < plan.nodes.size(); ++n) fill_node(plan.nodes[n], picture.nodes[n]);
    for (const compile::PlanWire& wire : plan.wires) {
        const auto to = static_cast<std::size_t>(wire.to_node);
        const int input = input_of(wire, plan.nodes[to], picture.nodes[to]);
        picture.nodes[to].inputs[static_cast<std::size_t>(input)].is_connected = true;
        if (wire.from_node < 0) continue;
        const compile::PlanNode& from = plan.nodes[static_cast<std::size_t>(wire.from_node)];
        const compile::PlanGroup& group = plan.groups[static_cast<std::size_t>(from.group)];
        const bool crosses = from.group != plan.nodes[to].group;
        picture.nodes[static_cast<std::size_t>(wire.from_node)]
            .outputs[static_cast<std::size_t>(wire.from_output)]
            .is_connected = true;
        picture.wires.push_back({wire.from_node,
                                 wire.from_output,
                                 wire.to_node,
                                 input,
                                 wire.mode,
                                 crosses ? compile::wire_latency(group, wire) : wire.delay * group.period,
                                 crosses,
                                 {},
                                 {}});
    }
    Arrangement(plan, picture).arrange();
    for (PictureNode& node : picture.nodes) place_ports(node);
    route_wires(picture);
    return picture;
}

Hit hit(const PatchPicture& picture, Point at, double reach) {
    const auto near = [&](Point p) { return std::abs(p.x - at.x) <= reach && std::abs(p.y - at.y) <= reach; };
    for (std::size_t n = 0; n < picture.nodes.size(); ++n) {
        const PictureNode& node = picture.nodes[n];
        const Box wide{node.box.left - reach, node.box.top, node.box.right + reach, node.box.bottom};
        if (!wide.contains(at)) continue;
        for (std::size_t i = 0; i < node.inputs.size(); ++i)
            if (near(node.inputs[i].at)) return {Hit::What::input, static_cast<int>(n), static_cast<int>(i)};
        for (std::size_t i = 0; i < node.outputs.size(); ++i)
            if (near(node.outputs[i].at)) return {Hit::What::output, static_cast<int>(n), static_cast<int>(i)};
        if (node.box.contains(at)) return {Hit::What::node, static_cast<int>(n), -1};
    }
    Hit best;
    double least = reach;
    for (std::size_t w = 0; w < picture.wires.size(); ++w) {
        const PictureWire& wire = picture.wires[w];
        const Box& b = wire.bounds;
        if (!Box{b.left - reach, b.top - reach, b.right + reach, b.bottom + reach}.contains(at)) continue;
        const double distance = distance_to(wire, at);
        if (distance > least) continue;
        least = distance;
        best = {Hit::What::wire, static_cast<int>(w), -1};
    }
    return best;
}

std::string describe(const PictureWire& wire) {
    constexpr std::string_view names[] = {"hold", "linear", "batch", "delay"};
    if (!wire.crosses && wire.latency == 0) return "same tick";
    return fmt::format("{}, {:.4g} ms", names[static_cast<std::size_t>(wire.mode)], seconds(wire.latency) * 1e3);
}

}  // namespace tactus::view

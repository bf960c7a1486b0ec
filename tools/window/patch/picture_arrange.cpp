// SPDX-License-Identifier: Apache-2.0
// Places of the nodes of a picture, and the routes of its wires.
#include "tools/window/patch/picture_arrange.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace tactus::window {

namespace {

constexpr double value_room = 60, row_gap = 18, lane_padding = 14, lane_gap = 14, left_edge = 40;

double height_of(const PictureNode& node) {
    const std::size_t rows = std::max<std::size_t>({node.inputs.size(), node.outputs.size(), 1});
    return title_height + static_cast<double>(rows) * port_height + 7.0;
}

/// Longer columns are split side by side, so that a lane of many nodes has the shape of a screen.
int max_rows(std::size_t nodes_of_lane) {
    constexpr double wide = 1.4;  // aspect ratio of a screen, in boxes
    return std::max(24, static_cast<int>(std::ceil(std::sqrt(wide * static_cast<double>(nodes_of_lane)))));
}

class Arrangement {
public:
    Arrangement(PatchPicture& picture, const std::vector<std::vector<int>>& orders, const patch::PatchWindow* window)
        : picture_(picture), orders_(orders), window_(window), depth_(picture.nodes.size()) {
        find_columns();
        feeding_.resize(picture.nodes.size());
        for (std::size_t w = 0; w < picture.wires.size(); ++w)
            feeding_[static_cast<std::size_t>(picture.wires[w].to)].push_back(w);
    }

    void arrange() {
        double top = 0.0;
        for (std::size_t lane = 0; lane < picture_.lanes.size(); ++lane) {
            picture_.lanes[lane].top = top;
            picture_.lanes[lane].bottom = arrange_lane(lane, top + lane_head_height) + lane_padding;
            top = picture_.lanes[lane].bottom + lane_gap;
        }
        picture_.bounds = {left_, 0.0, right_ + left_edge + value_room, std::max(top - lane_gap, 1.0)};
        for (const PictureComment& comment : picture_.comments) {
            Box& all = picture_.bounds;
            all = {std::min(all.left, comment.box.left), std::min(all.top, comment.box.top),
                   std::max(all.right, comment.box.right), std::max(all.bottom, comment.box.bottom)};
        }
    }

private:
    /// Longest path from a source within a lane; delay wires are ignored.
    void find_columns() {
        columns_.assign(picture_.nodes.size(), 0);
        std::vector<std::vector<int>> next(picture_.nodes.size());
        for (const PictureWire& wire : picture_.wires) {
            if (wire.mode == patch::WireMode::delay) continue;
            const auto from = static_cast<std::size_t>(wire.from), to = static_cast<std::size_t>(wire.to);
            if (from != to && picture_.nodes[from].group == picture_.nodes[to].group) next[from].push_back(wire.to);
        }
        for (const std::vector<int>& order : orders_)
            for (const int from : order)
                for (const int to : next[static_cast<std::size_t>(from)]) {
                    int& column = columns_[static_cast<std::size_t>(to)];
                    column = std::max(column, columns_[static_cast<std::size_t>(from)] + 1);
                }
    }

    double arrange_lane(std::size_t lane, double top) {
        const std::vector<int>& order = orders_[lane];
        const std::size_t first_stack = picture_.stacks.size();
        std::map<int, std::vector<int>> by_column;
        for (const int node : order) by_column[columns_[static_cast<std::size_t>(node)]].push_back(node);
        double x = left_edge, bottom = top + title_height;
        for (auto& [column, nodes] : by_column) {
            sort_by_sources(nodes);
            double y = top, gone = 0.0;
            int row = 0;
            for (const int index : nodes) {
                PictureNode& node = picture_.nodes[static_cast<std::size_t>(index)];
                if (row == max_rows(order.size())) {
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
        return std::max(bottom, place_by_hand(order, top - lane_head_height, top, first_stack));
    }

    /// Nodes that somebody has put somewhere. Returns the bottom of the lowest.
    double place_by_hand(const std::vector<int>& order, double lane_top, double min_y, std::size_t first_stack) {
        if (!window_ || window_->places.empty()) return 0.0;
        double bottom = 0.0;
        for (const int index : order) {
            PictureNode& node = picture_.nodes[static_cast<std::size_t>(index)];
            const auto found = window_->places.find(node.name);
            if (found == window_->places.end()) continue;
            const double x = found->second.x, y = std::max(lane_top + found->second.y, min_y);
            node.box = {x, y, x + node_width, y + height_of(node)};
            bottom = std::max(bottom, node.box.bottom);
            left_ = std::min(left_, x - left_edge);
            right_ = std::max(right_, node.box.right);
        }
        if (bottom == 0.0) return bottom;
        bottom = std::max(bottom, make_way(order));
        // The nodes are no stacks any more.
        picture_.stacks.resize(first_stack);
        for (const int index : order) picture_.stacks.push_back(picture_.nodes[static_cast<std::size_t>(index)].box);
        return bottom;
    }

    /// Moves nodes that nobody has put anywhere below those that are in their way. Returns the bottom of the lowest.
    double make_way(const std::vector<int>& order) {
        std::vector<Box> taken;
        for (const int index : order)
            if (const PictureNode& node = picture_.nodes[static_cast<std::size_t>(index)];
                window_->places.contains(node.name))
                taken.push_back(node.box);
        double bottom = 0.0;
        for (const int index : order) {
            PictureNode& node = picture_.nodes[static_cast<std::size_t>(index)];
            if (window_->places.contains(node.name)) continue;
            bool is_moved = false;
            for (auto other = taken.begin(); other != taken.end();) {
                if (!other->meets(node.box)) {
                    ++other;
                    continue;
                }
                node.box = {node.box.left, other->bottom + row_gap, node.box.right,
                            other->bottom + row_gap + node.box.height()};
                is_moved = true;
                other = taken.begin();
            }
            if (!is_moved) continue;
            taken.push_back(node.box);
            bottom = std::max(bottom, node.box.bottom);
        }
        return bottom;
    }

    /// Sorts the nodes of a column by their sources, so that fewer wires cross.
    void sort_by_sources(std::vector<int>& nodes) const {
        std::map<int, double> height;
        for (const int node : nodes) {
            double sum = 0.0;
            int count = 0;
            for (const std::size_t w : feeding_[static_cast<std::size_t>(node)]) {
                const PictureWire& wire = picture_.wires[w];
                const PictureNode& from = picture_.nodes[static_cast<std::size_t>(wire.from)];
                if (from.box.width() == 0.0) continue;
                sum += depth_[static_cast<std::size_t>(wire.from)] + title_height + wire.output * port_height;
                ++count;
            }
            height[node] = count > 0 ? sum / count : 1e9;
        }
        std::ranges::stable_sort(nodes, {}, [&](int node) { return height[node]; });
    }

    PatchPicture& picture_;
    const std::vector<std::vector<int>>& orders_;
    const patch::PatchWindow* window_;
    std::vector<int> columns_;
    std::vector<double> depth_;  ///< vertical position of each node without split columns
    std::vector<std::vector<std::size_t>> feeding_;
    double left_ = 0.0, right_ = left_edge + node_width;
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
constexpr std::size_t max_routed = 300;

void route_wires(PatchPicture& picture) {
    std::vector<Box> boxes;
    std::vector<double> levels;
    if (picture.nodes.size() <= max_routed) {
        for (const PictureNode& node : picture.nodes) boxes.push_back(node.box);
        for (const PictureLane& lane : picture.lanes) levels.push_back(lane.bottom + 0.5 * lane_gap);
        // No wires run below the picture.
        if (!levels.empty()) levels.back() = picture.lanes.back().bottom - 0.5 * lane_padding;
    }
    WireRouter router(std::move(boxes), levels);
    for (PictureWire& wire : picture.wires) {
        const auto& outputs = picture.nodes[static_cast<std::size_t>(wire.from)].outputs;
        const auto& inputs = picture.nodes[static_cast<std::size_t>(wire.to)].inputs;
        constexpr int max_outputs = 256;
        wire.way = router.way(outputs[static_cast<std::size_t>(wire.output)].at,
                              inputs[static_cast<std::size_t>(wire.input)].at, max_outputs * wire.from + wire.output);
        wire.bounds = bounds_of(wire.way.front());
        for (const BezierCurve& piece : wire.way) {
            const Box box = bounds_of(piece);
            wire.bounds = {std::min(wire.bounds.left, box.left), std::min(wire.bounds.top, box.top),
                           std::max(wire.bounds.right, box.right), std::max(wire.bounds.bottom, box.bottom)};
        }
    }
}

}  // namespace

void arrange(PatchPicture& picture, const std::vector<std::vector<int>>& orders, const patch::PatchWindow* window) {
    Arrangement(picture, orders, window).arrange();
    for (PictureNode& node : picture.nodes) place_ports(node);
    route_wires(picture);
}

}  // namespace tactus::window

// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/patch_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

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

patch::PatchPlace place_in_lane(const PatchPicture& picture, const PictureNode& node, Point corner) {
    return {corner.x, corner.y - picture.lanes[static_cast<std::size_t>(node.group)].top};
}

const PictureLane* lane_at(const PatchPicture& picture, Point at) {
    const auto found = std::ranges::find_if(
        picture.lanes, [&](const PictureLane& lane) { return at.y >= lane.top && at.y < lane.bottom; });
    return found == picture.lanes.end() ? nullptr : &*found;
}

double lane_top(const PatchPicture& picture, const std::string& lane) {
    if (lane.empty() || picture.lanes.empty()) return 0.0;
    constexpr double lane_gap = 14.0;
    const auto shown = std::ranges::find(picture.lanes, lane, &PictureLane::name);
    return shown == picture.lanes.end() ? picture.lanes.back().bottom + lane_gap : shown->top;
}

patch::PatchPlace place_for(const PatchPicture& picture, const std::string& lane, Point at) {
    return {at.x, std::max(at.y - lane_top(picture, lane), lane_head_height)};
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

}  // namespace tactus::window

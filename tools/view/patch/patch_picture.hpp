// SPDX-License-Identifier: Apache-2.0
// The layout of a patch: groups as lanes, nodes as boxes, ports on their edges, wires as curves. Geometry only; units
// are pixels at zoom 1.
#pragma once

#include "graph/compile/plan.hpp"
#include "tools/view/canvas.hpp"
#include "tools/view/patch/wire_route.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::view {

struct PicturePort {
    std::string name, about, unit;
    const ValueType* type = nullptr;  ///< null: any
    bool is_optional = false, is_connected = false;
    bool is_param = false;  ///< a driven parameter
    Point at;
};

struct PictureNode {
    std::string name, type;
    int group = 0;
    Box box;
    std::vector<PicturePort> inputs, outputs;
};

struct PictureWire {
    int from = 0, output = 0, to = 0, input = 0;
    patch::WireMode mode = patch::WireMode::hold;
    Flicks latency = 0;
    bool crosses = false;  ///< leads from one group to another
    std::vector<BezierCurve> way;  ///< consecutive pieces
    Box bounds;
};

struct PictureLane {
    std::string name, note;  ///< "1 kHz", "latency 1 ms"
    double top = 0.0, bottom = 0.0;
};

struct PatchPicture {
    std::vector<PictureLane> lanes;  ///< in the order of the plan's groups
    std::vector<PictureNode> nodes;  ///< in the order of the plan's nodes
    std::vector<PictureWire> wires;  ///< wires between nodes
    std::vector<Box> stacks;  ///< bounds of stacked boxes, for small zoom
    Box bounds;

    int find(std::string_view node) const;  ///< −1: none
};

inline constexpr double title_height = 38.0, port_height = 17.0, node_width = 158.0, column_gap = 100.0;

PatchPicture picture_of(const compile::Plan& plan);

/// The item at a point. Ports take precedence over nodes, nodes over wires.
struct Hit {
    enum class What { nothing, node, input, output, wire } what = What::nothing;
    int index = -1;  ///< index of the node or wire
    int port = -1;
    bool operator==(const Hit&) const = default;
};
Hit hit(const PatchPicture& picture, Point at, double reach);

/// Position for a label, on the middle piece of the wire.
Point middle_of(const PictureWire& wire);

/// "hold, 1 ms": delivery mode and delay of a wire.
std::string describe(const PictureWire& wire);

}  // namespace tactus::view

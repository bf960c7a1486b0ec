// SPDX-License-Identifier: Apache-2.0
// Where everything of a patch stands in its picture: groups as lanes, nodes as boxes, ports on their edges, wires as
// curves between them. Plain geometry; units are pixels at a zoom of one.
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
    bool is_param = false;  ///< a parameter that a wire drives
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
    bool crosses = false;  ///< from one group to another
    std::vector<BezierCurve> way;  ///< pieces that follow each other
    Box bounds;
};

struct PictureLane {
    std::string name, note;  ///< "1 kHz", "latency 1 ms"
    double top = 0.0, bottom = 0.0;
};

struct PatchPicture {
    std::vector<PictureLane> lanes;  ///< as the plan's groups
    std::vector<PictureNode> nodes;  ///< as the plan's
    std::vector<PictureWire> wires;  ///< those between nodes
    std::vector<Box> stacks;  ///< around the boxes that stand above each other, for a look from afar
    Box bounds;

    int find(std::string_view node) const;  ///< −1: none
};

inline constexpr double title_height = 38.0, port_height = 17.0, node_width = 158.0, column_gap = 100.0;

PatchPicture picture_of(const compile::Plan& plan);

/// What is under a point of the picture. Ports lie above nodes, nodes above wires.
struct Hit {
    enum class What { nothing, node, input, output, wire } what = What::nothing;
    int index = -1;  ///< of the node, or of the wire
    int port = -1;
    bool operator==(const Hit&) const = default;
};
Hit hit(const PatchPicture& picture, Point at, double reach);

/// In the middle piece of its way, where there is room to say something.
Point middle_of(const PictureWire& wire);

/// "hold, 1 ms": how a wire delivers.
std::string describe(const PictureWire& wire);

}  // namespace tactus::view

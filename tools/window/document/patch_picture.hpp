// SPDX-License-Identifier: Apache-2.0
// The layout of a patch: groups as lanes, nodes as boxes, ports on their edges, wires as curves. Geometry only; units
// are pixels at zoom 1.
#pragma once

#include "graph/compile/schedule.hpp"
#include "graph/patch/patch_window.hpp"
#include "tools/window/document/wire_route.hpp"
#include "tools/window/widgets/canvas.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::window {

struct PicturePort {
    std::string name, about, unit;
    const ValueType* type = nullptr;  ///< null: any
    bool is_optional = false, is_connected = false;
    bool is_param = false;  ///< a driven parameter
    Point at;
    bool takes_many = false;  ///< any number of wires: an input of events
    bool is_missing = false;  ///< a wire names it, and the node has no such port
};

struct PictureNode {
    std::string name, type;
    int group = 0;  ///< its lane
    Box box;
    std::vector<PicturePort> inputs, outputs;
    int plan = -1;          ///< its index in the plan; -1: a closed sub-patch, or unfinished
    bool is_part = false;   ///< a closed sub-patch
    std::string lacks;      ///< why it is unfinished; empty: it is not
    std::string colour;     ///< a name; empty: none
    bool is_at_fault = false;  ///< it cannot be made: `lacks` is an error
};

struct PictureComment {
    std::string name, text, colour;
    Box box;
};

/// An open sub-patch: the frame around its nodes in one lane.
struct PictureFrame {
    std::string name;
    Box box;
};

struct PictureWire {
    int from = 0, output = 0, to = 0, input = 0;
    patch::WireMode mode = patch::WireMode::hold;
    Flicks latency = 0;
    bool crosses = false;  ///< leads from one group to another
    std::vector<BezierCurve> way;  ///< consecutive pieces
    Box bounds;
    std::string fault;  ///< why it cannot be made; empty: it is
};

struct PictureLane {
    std::string name, note;  ///< "1 kHz", "latency 1 ms"
    double top = 0.0, bottom = 0.0;
};

struct PatchPicture {
    std::vector<PictureLane> lanes;  ///< in the order of the plan's groups
    std::vector<PictureNode>
        nodes;  ///< in the order of the plan's nodes, then closed sub-patches, then unfinished ones
    std::vector<PictureWire> wires;  ///< wires between nodes
    std::vector<PictureComment> comments;
    std::vector<PictureFrame> frames;
    std::vector<Box> stacks;  ///< bounds of stacked boxes, for small zoom
    Box bounds;

    int find(std::string_view node) const;  ///< −1: none
};

inline constexpr double title_height = 38.0, port_height = 17.0, node_width = 158.0, column_gap = 100.0;

struct Unfinished;

/// What of a patch is shown beside its plan.
struct PictureMatter {
    const compile::Schedule* plan = nullptr;  ///< null: nothing runs yet
    const Unfinished* unfinished = nullptr;
    const patch::PatchWindow* window = nullptr;
    std::vector<std::pair<std::string, std::string>> parts;  ///< name and type of each sub-patch
};

/// A sub-patch is one box unless the window says that it is open.
PatchPicture picture_of(const PictureMatter& matter);
PatchPicture picture_of(const compile::Schedule& plan);

/// Where a node stands within its lane, as a window keeps it.
patch::PatchPlace place_in_lane(const PatchPicture& picture, const PictureNode& node, Point corner);

/// The lane at a height; null: none is there.
const PictureLane* lane_at(const PatchPicture& picture, Point at);
/// The top of a lane, which may be new; 0: of no lane.
double lane_top(const PatchPicture& picture, const std::string& lane);
/// Where a node that is added at a point stands within a lane, which may be new.
patch::PatchPlace place_for(const PatchPicture& picture, const std::string& lane, Point at);

inline constexpr double lane_head_height = 30.0;

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

}  // namespace tactus::window

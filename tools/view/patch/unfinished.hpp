// SPDX-License-Identifier: Apache-2.0
// Nodes that are still being made: a required input has no wire, or a required asset is not named, or what feeds it is
// unfinished. They stand in the text of the patch, but not in what runs. No user interface.
#pragma once

#include "graph/compile/plan.hpp"
#include "tools/view/patch/patch_picture.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tactus::view {

/// The ports of a node type, by a node with default parameters.
struct TypePorts {
    struct File {
        std::string name, type;  ///< of the parameter; "bone"
    };
    std::vector<File> files;  ///< parameters that take one
    std::vector<PicturePort> inputs, outputs;
    std::vector<std::pair<std::string, std::string>> params;  ///< that wires may drive: name, unit
    std::vector<std::string> assets;  ///< required
};
/// Null: there is no such type. Only on the window's thread.
const TypePorts* ports_of_type(std::string_view type);

struct UnfinishedNode {
    std::string name, type, lane;  ///< lane: its rate or group
    std::vector<PicturePort> inputs, outputs;
    std::string lacks;  ///< "input 'pose'", "a wire"
};

struct Unfinished {
    std::vector<UnfinishedNode> nodes;
    std::vector<patch::PatchWire> wires;  ///< that begin or end there

    bool empty() const { return nodes.empty(); }
    const UnfinishedNode* find(std::string_view name) const;
    std::vector<std::string> names() const;
};

/// Adds to `problems` what is wrong with their wires: no such port, other types, an input with two wires.
Unfinished unfinished_of(const patch::Patch& patch, patch::Problems& problems);

}  // namespace tactus::view

// SPDX-License-Identifier: Apache-2.0
// Nodes that are still being made: a required input has no wire, or a required asset is not named, or what feeds it is
// unfinished; or there is an error in it. They stand in the text of the patch, but not in what runs. No user interface.
#pragma once

#include "graph/compile/schedule.hpp"
#include "tools/window/document/part_ports.hpp"
#include "tools/window/document/patch_picture.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::window {

struct UnfinishedNode {
    std::string name, type, lane;  ///< lane: its rate or group
    std::vector<PicturePort> inputs, outputs;
    std::string lacks;  ///< "input 'pose'", "a wire"
    bool is_at_fault = false;  ///< it cannot be made; `lacks` is the error
};

/// A wire that cannot be made: no such port, other types.
struct BrokenWire {
    patch::PatchWire wire;
    std::string why;
};

struct Unfinished {
    std::vector<UnfinishedNode> nodes;
    std::vector<patch::PatchWire> wires;  ///< that begin or end there
    std::vector<BrokenWire> broken;
    std::map<std::string, PartPorts> parts;  ///< of all sub-patches, by their types

    bool empty() const { return nodes.empty(); }
    const UnfinishedNode* find(std::string_view name) const;
    std::vector<std::string> names() const;
};

/// Adds to `problems` what is wrong with their wires: no such port, other types, an input with two wires. `at_fault`:
/// nodes that cannot be made, and why; what they feed is unfinished.
Unfinished unfinished_of(const patch::Patch& patch, patch::Problems& problems,
                         const std::map<std::string, std::string>& at_fault = {});

}  // namespace tactus::window

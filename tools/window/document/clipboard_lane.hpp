// SPDX-License-Identifier: Apache-2.0
// From where the comments of a copy are measured: nodes stand within their lanes, comments in the picture as a whole.
#pragma once

#include "graph/patch/patch.hpp"

#include <algorithm>
#include <string>

namespace tactus::window {

/// The lane of a node as the patch's text has it.
inline std::string lane_of(const patch::PatchNode& node) { return node.group.empty() ? node.rate : node.group; }

/// The lane of the first node by name, from whose top the comments are measured. Empty: no lane, from the top of the
/// picture.
inline std::string lane_of_comments(const patch::Patch& copy) {
    const auto first = std::ranges::min_element(copy.nodes, {}, &patch::PatchNode::name);
    return first == copy.nodes.end() ? std::string() : lane_of(*first);
}

}  // namespace tactus::window

// SPDX-License-Identifier: Apache-2.0
// The checks of one node type from outside of the tree.
#pragma once

#include "graph/node/node.hpp"

namespace tactus::check_node {

/// Runs every check, each in a process of its own, so that a node that crashes or never returns ends its check only. Prints a line
/// for each. Returns how many failed.
int check(const NodeType& type);

}  // namespace tactus::check_node

// SPDX-License-Identifier: Apache-2.0
// Node types that a program makes while it runs, in the table of all node types (nodes/catalogue.hpp).
#pragma once

#include "graph/node/node.hpp"

namespace tactus::nodes {

/// Adds a type that the program makes while it runs, or replaces one of this name that it added before. The type lives
/// as long as the program; a catalogue that was returned before stays as it is. Any thread. Throws Error if the name
/// belongs to Tactus or to a plug-in.
void declare(const NodeType& type);

}  // namespace tactus::nodes

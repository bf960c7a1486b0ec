// SPDX-License-Identifier: Apache-2.0
// The declaration of a node type from outside of the tree: tests of the tree keep those within it right.
#pragma once

#include "graph/node/node.hpp"

namespace tactus::plugin {

/// Makes a node and checks what its members say: unique names that a patch can use, defaults within their ranges, units that can
/// be read, texts. Throws Error; so may the constructor of the node.
void check_declaration(const NodeType& type);

}  // namespace tactus::plugin

// SPDX-License-Identifier: Apache-2.0
// The table of all node types.
#pragma once

#include "graph/compile/plan.hpp"

namespace tactus::nodes {

/// Every node type, sorted by name.
compile::Catalogue catalogue();

}  // namespace tactus::nodes

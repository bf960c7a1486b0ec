// SPDX-License-Identifier: Apache-2.0
// The table of all node types.
#pragma once

#include "graph/plan.hpp"

namespace tactus {

/// Every node type, sorted by name.
Catalogue catalogue();

}  // namespace tactus

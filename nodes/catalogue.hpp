// SPDX-License-Identifier: Apache-2.0
// The table of all node types.
#pragma once

#include "graph/compile/schedule.hpp"

namespace tactus::nodes {

/// Every node type, those of plug-ins too (graph/plugin/plugins.hpp), sorted by name. They are loaded at the first call. Throws
/// Error when one cannot be, or has a type of a name that is in use.
compile::Catalogue catalogue();

}  // namespace tactus::nodes

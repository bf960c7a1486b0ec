// SPDX-License-Identifier: Apache-2.0
// Decides which nodes survive unchanged when a plan replaces another.
#pragma once

#include "graph/compile/schedule.hpp"

#include <string>
#include <vector>

namespace tactus::build {

/// Returns for each node everything that its `prepare` may depend on, as text: type, structural parameters, choices,
/// texts, flags, vectors, assets, sources of inputs of any type, seed. If the text is equal, the node need not be
/// prepared again.
std::vector<std::string> structures_of(const compile::Schedule& plan);

}  // namespace tactus::build

// SPDX-License-Identifier: Apache-2.0
// Which nodes go on unchanged when a plan takes over from another.
#pragma once

#include "graph/plan.hpp"

#include <string>

namespace tactus {

/// All that a node's `prepare` may depend on, as text: type, structural parameters, choices, texts, flags, vectors,
/// assets, where inputs of any type come from, seed. Equal text means that the node need not be prepared again.
std::string structure_of(const Plan& plan, int node);

}  // namespace tactus

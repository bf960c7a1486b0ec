// SPDX-License-Identifier: Apache-2.0
// Which nodes go on unchanged when a plan takes over from another.
#pragma once

#include "graph/compile/plan.hpp"

#include <string>
#include <vector>

namespace tactus::build {

/// For each node everything that its `prepare` may depend on, as text: type, structural parameters, choices, texts, flags,
/// vectors, assets, where inputs of any type come from, seed. Equal text means that the node need not be prepared again.
std::vector<std::string> structures_of(const compile::Plan& plan);

}  // namespace tactus::build

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "graph/compile/plan.hpp"

namespace tactus::compile {

/// Gives the `AnyOut` outputs of each node, and its `AnyIn` inputs, the type that reaches one of the inputs by a wire.
/// A cycle that no type comes into carries numbers; what has no wire stays `value::undecided`. Wires that lead nowhere
/// are left for others to complain about.
void decide_types(Plan& plan);

}  // namespace tactus::compile

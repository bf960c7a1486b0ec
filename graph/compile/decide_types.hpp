// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "graph/compile/plan.hpp"

namespace tactus::compile {

/// Gives the `AnyOut` outputs of each node, and its `AnyIn` inputs, the type that reaches one of the inputs by a wire.
/// What no wire decides stays `value::undecided`. Wires that lead nowhere are left for others to complain about.
void decide_types(Plan& plan);

}  // namespace tactus::compile

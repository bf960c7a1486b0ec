// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "graph/compile/schedule.hpp"

namespace tactus::compile {

/// Sets the type of the `AnyOut` outputs and `AnyIn` inputs of each node to the type that a wire brings to one of its
/// inputs. A cycle that receives no type from outside carries numbers. Ports without a wire stay `value::undecided`.
/// Dangling wires are not reported here; resolve_wires reports them.
void decide_types(Schedule& plan);

}  // namespace tactus::compile

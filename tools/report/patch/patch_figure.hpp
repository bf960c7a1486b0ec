// SPDX-License-Identifier: Apache-2.0
// Drawing of a compiled graph.
#pragma once

#include "devices/display/figure.hpp"
#include "graph/compile/schedule.hpp"

namespace tactus::report {

/// Draws groups as lanes, nodes from left to right in the order in which values flow, wires coloured by type; wires between
/// groups are dashed and carry their mode and latency.
display::Figure draw_patch(const compile::Schedule& plan);

}  // namespace tactus::report

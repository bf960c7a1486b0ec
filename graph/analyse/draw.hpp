// SPDX-License-Identifier: Apache-2.0
// Draws the compiled graph as an SVG image.
#pragma once

#include "graph/compile/schedule.hpp"

#include <string>

namespace tactus::analyse {

/// Returns the plan as a self-contained SVG image: groups as lanes, nodes from left to right in the order values flow,
/// wires coloured by type; wires between groups are dashed and carry their mode and latency.
std::string draw_svg(const compile::Schedule& plan);

}  // namespace tactus::analyse

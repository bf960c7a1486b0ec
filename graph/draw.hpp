// SPDX-License-Identifier: Apache-2.0
// A picture of the compiled graph.
#pragma once

#include "graph/plan.hpp"

#include <string>

namespace tactus {

/// The plan as a self-contained SVG: groups as lanes, nodes from left to right in the order values flow, wires coloured
/// by type; wires between groups are dashed and carry their mode and latency.
std::string draw_svg(const Plan& plan);

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// Text about the forces on the hand in a run.
#pragma once

#include "graph/node/node.hpp"

#include <string>

namespace tactus::run {

/// Returns a number of a report; `otherwise` if there is none.
double number_in(const Report& report, const char* section, const char* key, double otherwise = 0.0);

/// Returns lines on contact and force. The thrust is reported as rendered: if forces were off, with the rendered
/// fraction and the time from which they were off.
std::string force_text(const Report& report);

}  // namespace tactus::run

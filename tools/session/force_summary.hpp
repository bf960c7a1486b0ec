// SPDX-License-Identifier: Apache-2.0
// What a hand felt in a run, as text.
#pragma once

#include "graph/node/node.hpp"

#include <string>

namespace tactus::session {

/// A number of a report; `otherwise` when it has none.
double number_in(const Report& report, const char* section, const char* key, double otherwise = 0.0);

/// Lines on contact and force. A thrust is told only as far as the hand felt it: when forces were off, how much was felt
/// and from when on they were off.
std::string force_text(const Report& report);

}  // namespace tactus::session

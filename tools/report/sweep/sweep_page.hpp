// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/analysis/sweep/results.hpp"

#include <string>

namespace tactus::report {

/// A page about a sweep: failures with their reasons, figures of the sweep file with their numbers, and what ran it.
/// Throws Error for conflicts.
std::string sweep_page(const analysis::Results& results);

}  // namespace tactus::report

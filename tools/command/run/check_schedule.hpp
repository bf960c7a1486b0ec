// SPDX-License-Identifier: Apache-2.0
// The part of `tactus check` on the order in which groups are scheduled, and the load that they may take.
#pragma once

#include "assets/file/json.hpp"
#include "graph/compile/schedule.hpp"

#include <functional>
#include <string>
#include <vector>

namespace tactus::command {

/// The cost of one call of each group, in s, as plan.groups: from a short run on the virtual clock. Empty when the patch
/// needs hardware, which is not opened here.
std::vector<double> measured_costs(const std::function<compile::Schedule()>& plan);

/// The groups in the order of their priority.
file::Json schedule_json(const compile::Schedule& plan, const std::vector<double>& cost_s);

/// A warning for each class on which a hand depends and that does not fit, also when all else waits.
std::vector<std::string> schedule_warnings(const compile::Schedule& plan, const std::vector<double>& cost_s);

void print_schedule(const file::Json& schedule);

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
// Whether the groups of a plan meet their deadlines on one core, in the order of their priorities.
#pragma once

#include "graph/compile/schedule.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::analyse {

struct ScheduledGroup {
    std::string group;
    compile::Criticality criticality = compile::Criticality::other;
    double period_s = 0.0;  ///< between two calls
    double cost_s = 0.0;    ///< measured duration of one call; 0: unknown
    /// Longest time from when a call is due to its end, including all interruptions by groups of higher or equal
    /// priority. Empty if the call never ends.
    std::optional<double> response_s = 0.0;

    double load() const { return cost_s / period_s; }
    bool fits() const { return response_s && *response_s <= period_s; }
};

/// Returns the groups in the order of priority. `cost_s` has the measured cost of each group, in the order of
/// plan.groups; missing entries count as 0. Response times are computed for fixed priorities on one core (Joseph and
/// Pandya 1986), from R = C + sum of ceil(R / T) C over the groups before.
std::vector<ScheduledGroup> schedule_of(const compile::Schedule& plan, const std::vector<double>& cost_s);

/// Largest total load of one core at which `count` groups meet all deadlines, whatever their periods: the
/// rate-monotonic bound count (2^(1/count) − 1) (Liu and Layland 1973).
double load_bound(int count);

/// Returns text such as "force output" or "sound".
const char* describe(compile::Criticality criticality) noexcept;

}  // namespace tactus::analyse

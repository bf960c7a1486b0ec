// SPDX-License-Identifier: Apache-2.0
// Whether the groups of a plan meet their deadlines on one core, in the order of their priorities.
#pragma once

#include "graph/compile/plan.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::analyse {

struct ScheduledGroup {
    std::string group;
    compile::Criticality criticality = compile::Criticality::other;
    double period_s = 0.0;  ///< between two calls
    double cost_s = 0.0;    ///< of one call, as measured; 0: unknown
    /// From when a call is due to its end, with all interruptions by groups of higher or equal priority; none: it never
    /// ends.
    std::optional<double> response_s = 0.0;

    double load() const { return cost_s / period_s; }
    bool fits() const { return response_s && *response_s <= period_s; }
};

/// In the order of priority. `cost_s` of each group, as plan.groups; missing ones count as 0. Response times are those of
/// fixed priorities on one core (Joseph and Pandya 1986), from R = C + sum of ceil(R / T) C over the groups before.
std::vector<ScheduledGroup> schedule_of(const compile::Plan& plan, const std::vector<double>& cost_s);

/// The part of a core that `count` groups may use in all and always meet their deadlines, whatever their periods: the
/// rate-monotonic bound count (2^(1/count) − 1) (Liu and Layland 1973).
double load_bound(int count);

/// "force output", "sound".
const char* describe(compile::Criticality criticality) noexcept;

}  // namespace tactus::analyse

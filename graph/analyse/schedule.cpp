// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/schedule.hpp"

#include "graph/compile/force_path.hpp"

#include <cmath>
#include <cstddef>

namespace tactus::analyse {

namespace {

std::optional<double> response_of(const std::vector<ScheduledGroup>& groups, std::size_t at) {
    constexpr int max_rounds = 1000;
    double response = groups[at].cost_s;
    for (int round = 0; round < max_rounds; ++round) {
        double next = groups[at].cost_s;
        for (std::size_t g = 0; g < at; ++g)
            // The tolerance keeps a response of exactly one period from counting twice.
            next += std::ceil(response / groups[g].period_s - 1e-9) * groups[g].cost_s;
        if (next <= response * (1.0 + 1e-12)) return response;
        if (next > groups[at].period_s * max_rounds) return std::nullopt;
        response = next;
    }
    return std::nullopt;
}

}  // namespace

std::vector<ScheduledGroup> schedule_of(const compile::Schedule& plan, const std::vector<double>& cost_s) {
    std::vector<ScheduledGroup> groups;
    for (const int g : compile::by_priority(plan)) {
        const auto index = static_cast<std::size_t>(g);
        const compile::ScheduleGroup& group = plan.groups[index];
        groups.push_back({group.name,
                          group.criticality,
                          seconds(compile::call_period(plan, group)),
                          index < cost_s.size() ? cost_s[index] : 0.0,
                          {}});
    }
    for (std::size_t g = 0; g < groups.size(); ++g) groups[g].response_s = response_of(groups, g);
    return groups;
}

double load_bound(int count) { return count > 0 ? count * (std::exp2(1.0 / count) - 1.0) : 1.0; }

const char* describe(compile::Criticality criticality) noexcept {
    switch (criticality) {
        case compile::Criticality::force_output: return "force output";
        case compile::Criticality::force_value: return "force value";
        case compile::Criticality::sound: return "sound";
        case compile::Criticality::world_value: return "world value";
        case compile::Criticality::other: return "other";
    }
    return "unknown";
}

}  // namespace tactus::analyse

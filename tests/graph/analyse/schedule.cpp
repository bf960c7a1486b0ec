// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/schedule.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <string>
#include <vector>

using namespace tactus;
using compile::Criticality;

namespace {

constexpr Flicks step = flicks_per_second / 1000;

compile::Schedule plan_of(const std::vector<std::pair<Criticality, int>>& groups) {
    compile::Schedule plan;
    for (const auto& [criticality, period] : groups) {
        compile::ScheduleGroup& group = plan.groups.emplace_back();
        group.name = std::to_string(plan.groups.size());
        group.criticality = criticality;
        group.period = period * step;
    }
    return plan;
}

/// The first call of the last of `groups` when all are released at once, step by step; -1: not within 4 of its periods.
int simulated_response(const std::vector<analyse::ScheduledGroup>& groups, std::size_t last) {
    std::vector<int> left(last + 1);
    const auto in_steps = [](double s) { return static_cast<int>(std::lround(s * 1000.0)); };
    for (int now = 0; now < 4 * in_steps(groups[last].period_s); ++now) {
        for (std::size_t g = 0; g <= last; ++g)
            if (now % in_steps(groups[g].period_s) == 0 && (g < last || now == 0))
                left[g] += in_steps(groups[g].cost_s);
        for (std::size_t g = 0; g <= last; ++g) {
            if (left[g] == 0) continue;
            --left[g];
            if (g == last && left[g] == 0) return now + 1;
            break;
        }
    }
    return -1;
}

}  // namespace

TEST_CASE("groups are ordered by criticality, then by their rate of calls, then by name") {
    const compile::Schedule plan = plan_of({{Criticality::other, 1},
                                            {Criticality::sound, 2},
                                            {Criticality::force_value, 4},
                                            {Criticality::force_output, 8},
                                            {Criticality::force_value, 2},
                                            {Criticality::force_value, 2},
                                            {Criticality::world_value, 1}});
    std::string order;
    for (const analyse::ScheduledGroup& group : analyse::schedule_of(plan, {})) order += group.group;
    CHECK(order == "4563271");
}

TEST_CASE("response times are those of a simulated core") {
    const Random random{7};
    std::uint64_t draws = 0;
    int late = 0;
    for (int example = 0; example < 300; ++example) {
        std::vector<std::pair<Criticality, int>> groups;
        std::vector<double> costs;
        for (int g = 0; g < 4; ++g) {
            const auto criticality = static_cast<Criticality>(random.bits(draws++) % 5);
            groups.emplace_back(criticality, 2 + static_cast<int>(random.bits(draws++) % 12));
            costs.push_back(1e-3 * static_cast<double>(random.bits(draws++) % 4));
        }
        const auto schedule = analyse::schedule_of(plan_of(groups), costs);
        for (std::size_t g = 0; g < schedule.size(); ++g) {
            const int simulated = simulated_response(schedule, g);
            if (schedule[g].cost_s == 0.0 || simulated < 0) continue;
            CAPTURE(example, g);
            REQUIRE(schedule[g].response_s);
            CHECK(*schedule[g].response_s * 1000.0 == Approx(simulated));
            CHECK(schedule[g].fits() == (simulated <= std::lround(schedule[g].period_s * 1000.0)));
            late += !schedule[g].fits();
        }
    }
    CHECK(late > 10);
}

TEST_CASE("groups that stay within the rate-monotonic bound meet their deadlines") {
    CHECK(analyse::load_bound(1) == Approx(1.0));
    CHECK(analyse::load_bound(2) == Approx(0.8284).epsilon(1e-3));
    for (const int count : {1, 2, 3, 5}) {
        std::vector<std::pair<Criticality, int>> groups;
        std::vector<double> costs;
        for (int g = 0; g < count; ++g) {
            groups.emplace_back(Criticality::force_value, 7 + 3 * g);
            costs.push_back(analyse::load_bound(count) / count * 1e-3 * (7 + 3 * g));
        }
        for (const analyse::ScheduledGroup& group : analyse::schedule_of(plan_of(groups), costs)) CHECK(group.fits());
    }
}

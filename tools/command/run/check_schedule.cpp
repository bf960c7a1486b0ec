// SPDX-License-Identifier: Apache-2.0
#include "tools/command/run/check_schedule.hpp"

#include "dsp/core/error.hpp"
#include "engine/run/demotions.hpp"
#include "engine/run/engine.hpp"
#include "engine/run/priority.hpp"
#include "graph/analyse/schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace tactus::command {

using file::Json;

namespace {

constexpr double measured_s = 0.2;  // logical
constexpr auto longest_measurement = std::chrono::seconds(1);
constexpr double cost_quantile = 0.99;

/// The part of a core that the groups up to `last` may use in all: the watchdog demotes a group beyond its own limit.
double bound_up_to(std::size_t last) {
    return std::min(analyse::load_bound(static_cast<int>(last) + 1), run::Demotions::largest_load);
}

}  // namespace

std::vector<double> measured_costs(const std::function<compile::Schedule()>& plan) {
    try {
        run::EngineOptions options;
        options.seconds = measured_s;
        options.hash = options.time_nodes = false;
        run::Engine engine(plan(), options);
        const auto begin = std::chrono::steady_clock::now();
        engine.render(1, [&](double) {
            if (std::chrono::steady_clock::now() - begin > longest_measurement) engine.stop();
        });
        std::vector<double> costs;
        for (const auto& group : engine.groups())
            costs.push_back(group->telemetry.execution.quantile_ns(cost_quantile) * 1e-9);
        return costs;
    } catch (const Error&) {
        return {};
    }
}

Json schedule_json(const compile::Schedule& plan, const std::vector<double>& cost_s) {
    Json rows = Json::array();
    const std::vector<analyse::ScheduledGroup> groups = analyse::schedule_of(plan, cost_s);
    double before = 0.0;  // load of the more critical groups
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const analyse::ScheduledGroup& group = groups[g];
        Json row{{"group", group.group},
                 {"class", analyse::describe(group.criticality)},
                 {"calls_per_s", 1.0 / group.period_s},
                 {"priority", run::priority_of(group.criticality, std::llround(group.period_s * flicks_per_second))},
                 {"may_use_percent", std::max(0.0, bound_up_to(g) - before) * 100.0},
                 {"cost_us", nullptr},
                 {"load_percent", nullptr},
                 {"response_us", nullptr},
                 {"fits", nullptr}};
        if (!cost_s.empty()) {
            row["cost_us"] = group.cost_s * 1e6;
            row["load_percent"] = group.load() * 100.0;
            row["response_us"] = group.response_s ? Json(*group.response_s * 1e6) : Json();
            row["fits"] = group.fits();
        }
        before += group.load();
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<std::string> schedule_warnings(const compile::Schedule& plan, const std::vector<double>& cost_s) {
    std::vector<std::string> warnings;
    for (const analyse::ScheduledGroup& group : analyse::schedule_of(plan, cost_s))
        if (group.criticality <= compile::Criticality::force_value && !group.fits())
            warnings.push_back(
                fmt::format("group '{}' ({}) needs {:.3g} us per call, and {} of its period of {:.4g} ms on one core: "
                            "the hand will "
                            "miss ticks; lower its rate, or move nodes that no force depends on to another group",
                            group.group, analyse::describe(group.criticality), group.cost_s * 1e6,
                            group.response_s ? fmt::format("{:.0f} %", *group.response_s / group.period_s * 100.0)
                                             : "more than all",
                            group.period_s * 1e3));
    return warnings;
}

void print_schedule(const Json& schedule) {
    fmt::print("\n{:<16} {:<13} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "order of groups", "class", "calls", "priority",
               "may use", "cost", "ends in");
    for (const Json& row : schedule) {
        std::string line = fmt::format("{:<16} {:<13} {:>6.4g} Hz {:>9} {:>7.0f} %", row["group"].get<std::string>(),
                                       row["class"].get<std::string>(), row["calls_per_s"].get<double>(),
                                       row["priority"].get<int>(), row["may_use_percent"].get<double>());
        if (!row["cost_us"].is_null()) line += fmt::format(" {:>6.3g} us", row["cost_us"].get<double>());
        if (!row["response_us"].is_null())
            line += fmt::format(" {:>6.3g} us{}", row["response_us"].get<double>(),
                                row["fits"].get<bool>() ? "" : "  TOO LATE");
        fmt::print("{}\n", line);
    }
    fmt::print("May use: of one core, beside the groups above (rate-monotonic bound, at most {:.0f} % in all).\n",
               run::Demotions::largest_load * 100.0);
}

}  // namespace tactus::command

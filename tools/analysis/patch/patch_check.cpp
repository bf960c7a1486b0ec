// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/patch/patch_check.hpp"

#include "dsp/core/error.hpp"
#include "engine/io/host.hpp"
#include "engine/run/demotions.hpp"
#include "engine/run/engine.hpp"
#include "engine/run/priority.hpp"
#include "graph/compile/sounds.hpp"
#include "nodes/device/cap_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace tactus::analysis {

namespace {

constexpr double measured_s = 0.2;  // logical
constexpr auto longest_measurement = std::chrono::seconds(1);
constexpr double cost_quantile = 0.99;

/// The part of a core that the groups up to `last` may use in all: the watchdog demotes a group beyond its own limit.
double bound_up_to(std::size_t last) {
    return std::min(analyse::load_bound(static_cast<int>(last) + 1), run::Demotions::largest_load);
}

/// What the energy cap of a device_output bounds, J: its largest force at the stiffness that its loops declare.
double energy_bound(const build::LiveNode& node, const std::vector<analyse::ForceLoop>& loops) {
    double stiffness = 0.0;
    for (const analyse::ForceLoop& loop : loops)
        if (loop.to == node.name)
            stiffness = std::max(
                stiffness, loop.declared ? loop.declared->newton_per_metre : std::numeric_limits<double>::infinity());
    const io::DeviceSlot& slot = *node.uses.devices.front().first;
    const double stated = slot.port.info.max_force, given = node.params.at("max_force")->value;
    return control::EnergyCap::max_gain(nodes::cap_settings(slot.port.info, seconds(slot.period)), stiffness,
                                        stated > 0.0 ? std::min(stated, given) : given);
}

}  // namespace

bool PatchCheck::is_stable() const {
    return std::ranges::all_of(loops, &CheckedLoop::is_stable) && std::ranges::none_of(paths, [](const CheckedPath& p) {
               return p.loop && p.loop->verdict() != analyse::Verdict::stable &&
                      p.loop->verdict() != analyse::Verdict::unknown;
           });
}

bool PatchCheck::is_unknown() const {
    return std::ranges::any_of(
        paths, [](const CheckedPath& p) { return p.loop && p.loop->verdict() == analyse::Verdict::unknown; });
}

std::vector<CheckedGroup> checked_groups(const compile::Schedule& plan) {
    std::vector<CheckedGroup> all;
    for (const compile::ScheduleGroup& group : plan.groups) {
        all.push_back({group.name, rate_of(group.period), seconds(group.latency) * 1e3, {}});
        for (const int node : group.order) all.back().nodes.push_back(plan.nodes[static_cast<std::size_t>(node)].name);
    }
    return all;
}

std::vector<CheckedPath> checked_paths(const compile::Schedule& plan, const std::vector<analyse::ForceLoop>& loops) {
    std::vector<CheckedPath> all;
    for (analyse::PathLatency& path : analyse::path_latencies(plan)) {
        const auto loop = std::ranges::find_if(
            loops, [&](const analyse::ForceLoop& one) { return one.from == path.from && one.to == path.to; });
        all.push_back({std::move(path), loop == loops.end() ? std::nullopt : std::optional(*loop)});
    }
    return all;
}

std::vector<CheckedLoop> checked_loops(const std::vector<std::shared_ptr<build::LiveNode>>& nodes) {
    std::vector<CheckedLoop> loops;
    for (const auto& node : nodes) {
        if (node->type->name != "admittance_controller") continue;
        Report report;
        node->type->report(node->instance.get(), report);
        const auto number = [&](const char* key) { return std::get<double>(report.sections.at(node->name).at(key)); };
        loops.push_back(
            {node->name, number("gain_per_s"), number("gain_limit_per_s"), node->params.at("hand_stiffness")->value});
    }
    return loops;
}

std::vector<CheckedOutput> checked_outputs(const std::vector<std::shared_ptr<build::LiveNode>>& nodes,
                                           const std::vector<analyse::ForceLoop>& loops,
                                           std::vector<std::string>& warnings) {
    std::vector<CheckedOutput> outputs;
    for (const auto& node : nodes) {
        if (node->type->name != "device_output") continue;
        Report report;
        node->type->report(node->instance.get(), report);
        const std::string& cap = std::get<std::string>(report.sections.at("force").at("energy_cap"));
        outputs.push_back({node->name, cap == "on" ? std::optional(energy_bound(*node, loops)) : std::nullopt});
        if (cap == "off")
            warnings.push_back(fmt::format(
                "{}: the energy cap is off; contacts may return more energy than the hand has put in", node->name));
    }
    return outputs;
}

std::optional<CheckedSound> checked_sound(const compile::Schedule& plan) {
    CheckedSound sound{1e3 * io::AudioChoice{}.margin_s, {}, false, false};
    for (const compile::ScheduleNode& node : plan.nodes) {
        sound.plays |= node.type->role == NodeRole::sound_sink;
        sound.hears |= compile::sound_source(node).has_value();
    }
    if (!sound.plays && !sound.hears) return std::nullopt;
    try {
        for (const audio::AudioCard& card : audio::list_audio_cards())
            if (card.is_default) sound.card = card;
    } catch (const Error&) {
        // Without a sound system there is no card.
    }
    return sound;
}

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

std::vector<CheckedSchedule> checked_schedule(const compile::Schedule& plan, const std::vector<double>& cost_s) {
    std::vector<CheckedSchedule> all;
    const std::vector<analyse::ScheduledGroup> groups = analyse::schedule_of(plan, cost_s);
    double before = 0.0;  // load of the more critical groups
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const analyse::ScheduledGroup& group = groups[g];
        all.push_back({group, run::priority_of(group.criticality, std::llround(group.period_s * flicks_per_second)),
                       std::max(0.0, bound_up_to(g) - before), !cost_s.empty()});
        before += group.load();
    }
    return all;
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

}  // namespace tactus::analysis

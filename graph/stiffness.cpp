// SPDX-License-Identifier: Apache-2.0
#include "graph/stiffness.hpp"

#include "dsp/core/units.hpp"
#include "graph/latency.hpp"

#include <algorithm>
#include <tuple>

namespace tactus {

namespace {

std::string setting_of(const Plan& plan, std::size_t node, std::string_view name) {
    for (const OptionText& given : plan.patch.nodes[node].settings)
        if (given.name == name) return given.text;
    return {};
}

/// Largest value that a parameter has, or takes while a wire drives it.
double largest(const Plan& plan, const Param& param) {
    const bool is_driven = std::ranges::any_of(plan.wires, [&](const PlanWire& w) { return w.param == &param; });
    return is_driven ? param.max : param.value;
}

std::optional<DeclaredStiffness> stiffest(const Plan& plan, const PlanNode& node) {
    static const Dimension force_per_distance = parse_unit("N/m").dimension;
    std::optional<DeclaredStiffness> found;
    for (const auto& [name, param] : node.params) {
        if (param->is_internal || parse_unit(param->unit).dimension != force_per_distance) continue;
        const double value = largest(plan, *param);
        if (!found || value > found->newton_per_metre) found = {node.name + "." + name, value};
    }
    return found;
}

/// What a metre of the device is in the scene, behind this way: workspaces multiply.
double scale_of(const Plan& plan, const Ages& from_source, std::size_t node) {
    double scale = 1.0;
    for (int at = static_cast<int>(node); at >= 0; at = from_source.before[static_cast<std::size_t>(at)]) {
        const PlanNode& passed = plan.nodes[static_cast<std::size_t>(at)];
        if (passed.type->role == NodeRole::placement) scale *= passed.params.at("scale")->value;
    }
    return scale;
}

}  // namespace

std::vector<ForceLoop> force_loops(const Plan& plan, const std::function<double(const std::string&)>& damping) {
    std::vector<Ages> ages(plan.nodes.size());  // made when asked for
    const auto from = [&](std::size_t n) -> const Ages& {
        if (ages[n].age.empty()) ages[n] = ages_from(plan, static_cast<int>(n));
        return ages[n];
    };
    std::vector<std::pair<std::size_t, DeclaredStiffness>> springs;
    for (std::size_t n = 0; n < plan.nodes.size(); ++n)
        if (const auto declared = stiffest(plan, plan.nodes[n])) springs.emplace_back(n, *declared);

    std::vector<ForceLoop> loops;
    for (std::size_t source = 0; source < plan.nodes.size(); ++source) {
        if (plan.nodes[source].type->role != NodeRole::hand_source) continue;
        for (std::size_t sink = 0; sink < plan.nodes.size(); ++sink) {
            if (plan.nodes[sink].type->role != NodeRole::hand_sink || from(source).age[sink] == unreached) continue;
            const double period = seconds(plan.groups[static_cast<std::size_t>(plan.nodes[sink].group)].period);
            const double b = damping(setting_of(plan, sink, "device"));
            const auto loop_of = [&](Flicks latency, std::optional<DeclaredStiffness> declared) {
                return ForceLoop{plan.nodes[source].name,
                                 plan.nodes[sink].name,
                                 seconds(latency),
                                 b,
                                 stiffness_limit(b, period, seconds(latency)),
                                 std::move(declared)};
            };
            std::optional<ForceLoop> worst;
            for (const auto& [spring, declared] : springs) {
                const Flicks there = from(source).age[spring], back = from(spring).age[sink];
                if (there == unreached || back == unreached) continue;
                const double scale = scale_of(plan, from(source), spring);
                DeclaredStiffness felt{declared.param, declared.newton_per_metre * scale * scale};
                ForceLoop loop = loop_of(there + back, std::move(felt));
                // Stiffness times lateness: what comes closest to the limit, also for a device of unknown damping.
                const auto strain = [period](const ForceLoop& l) {
                    return l.declared->newton_per_metre * (0.5 * period + l.latency_s);
                };
                if (!worst || strain(loop) > strain(*worst)) worst = std::move(loop);
            }
            loops.push_back(worst ? std::move(*worst) : loop_of(from(source).age[sink], std::nullopt));
        }
    }
    std::ranges::sort(
        loops, [](const ForceLoop& a, const ForceLoop& b) { return std::tie(a.from, a.to) < std::tie(b.from, b.to); });
    return loops;
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/stiffness.hpp"

#include "dsp/control/stated_hand.hpp"
#include "dsp/core/units.hpp"
#include "graph/analyse/latency.hpp"
#include "graph/analyse/slopes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tactus::analyse {

namespace {

std::string setting_of(const compile::Schedule& plan, std::size_t node, std::string_view name) {
    for (const OptionText& given : plan.patch.nodes[node].settings)
        if (given.name == name) return given.text;
    return {};
}

DrivenParams driven_params(const compile::Schedule& plan) {
    DrivenParams driven;
    for (const compile::ScheduleWire& wire : plan.wires)
        if (wire.param) driven.insert(wire.param);
    return driven;
}

bool is_felt(const Param& param) {
    static const Dimension force_per_distance = parse_unit("N/m").dimension;
    return !param.is_internal && parse_unit(param.unit).dimension == force_per_distance;
}

/// What a tool multiplies its forces on the device by, and with them its stiffness.
double device_scale(const compile::ScheduleNode& node) {
    const auto found = node.params.find("device_scale");
    return found != node.params.end() ? found->second->value : 1.0;
}

/// The node's largest stiffness: the value that a parameter has, or the largest while a wire drives it.
std::optional<DeclaredStiffness> stiffest(const DrivenParams& driven, const compile::ScheduleNode& node) {
    std::optional<DeclaredStiffness> found;
    for (const auto& [name, param] : node.params) {
        if (!is_felt(*param)) continue;
        const double value = (driven.contains(param) ? param->max : param->value) * device_scale(node);
        if (!found || value > found->newton_per_metre) found = {node.name + "." + name, value, driven.contains(param)};
    }
    return found;
}

/// Which nodes carry what some hand does.
std::vector<bool> reached_by_hands(const compile::Schedule& plan) {
    std::vector<bool> reached(plan.nodes.size(), false);
    for (std::size_t source = 0; source < plan.nodes.size(); ++source) {
        if (plan.nodes[source].type->role != NodeRole::hand_source) continue;
        const Ages from = ages_from(plan, static_cast<int>(source));
        for (std::size_t n = 0; n < plan.nodes.size(); ++n)
            if (from.age[n] != unreached) reached[n] = true;
    }
    return reached;
}

/// The scale from the device to the scene on the quickest path from a source: the product of its workspaces.
class Scales {
public:
    Scales(const compile::Schedule& plan, const Ages& from_source)
        : plan_(plan), before_(from_source.before), nearest_(plan.nodes.size(), unknown) {}

    double of(std::size_t node) {
        double scale = 1.0;
        for (int at = workspace_at(static_cast<int>(node)); at >= 0;
             at = workspace_at(before_[static_cast<std::size_t>(at)]))
            scale *= plan_.nodes[static_cast<std::size_t>(at)].params.at("scale")->value;
        return scale;
    }

private:
    static constexpr int unknown = -2;

    /// The first workspace on the way back, `node` itself among them; −1: there is none.
    int workspace_at(int node) {
        way_.clear();
        int at = node;
        for (; at >= 0 && nearest_[static_cast<std::size_t>(at)] == unknown;
             at = before_[static_cast<std::size_t>(at)]) {
            way_.push_back(at);
            if (plan_.nodes[static_cast<std::size_t>(at)].type->role == NodeRole::placement) {
                nearest_[static_cast<std::size_t>(at)] = at;
                break;
            }
        }
        const int found = at < 0 ? -1 : nearest_[static_cast<std::size_t>(at)];
        for (const int passed : way_) nearest_[static_cast<std::size_t>(passed)] = found;
        return found;
    }

    const compile::Schedule& plan_;
    const std::vector<int>& before_;
    std::vector<int> nearest_;  // workspace of each node that was asked for or passed
    std::vector<int> way_;
};

}  // namespace

Verdict ForceLoop::verdict() const {
    if (!declared) return Verdict::stable;
    const double stiffness = declared->newton_per_metre;
    if (max_stiffness > 0.0 && stiffness > max_stiffness) return Verdict::too_stiff;
    if (stiffness < limit) return Verdict::stable;
    return is_damping_stated ? Verdict::too_stiff : Verdict::unknown;
}

double damping_with_hand(const DeviceInfo& device) {
    return device.damping > 0.0 ? device.damping : control::StatedHand::damping;
}

std::span<const DeviceClass> device_classes() {
    static constexpr DeviceClass classes[] = {
        {"light stylus arm (Touch)", 0.1, 1e-3, 1000.0},
        {"light stylus arm (Touch X, Premium)", 0.2, 1e-3, 1500.0},
        {"small parallel device (Falcon)", 1.0, 1e-3, 3000.0},
        {"stiff parallel device (omega, delta)", 0.5, 0.5e-3, 14500.0},
        {"large arm (Virtuose)", 6.0, 1e-3, 2500.0},
    };
    return classes;
}

std::vector<FeltSpring> felt_springs(const compile::Schedule& plan) {
    const DrivenParams driven = driven_params(plan);
    std::vector<FeltSpring> felt;
    for (std::size_t source = 0; source < plan.nodes.size(); ++source) {
        if (plan.nodes[source].type->role != NodeRole::hand_source) continue;
        const Ages from = ages_from(plan, static_cast<int>(source));
        Scales scales(plan, from);
        for (std::size_t sink = 0; sink < plan.nodes.size(); ++sink) {
            if (plan.nodes[sink].type->role != NodeRole::hand_sink || from.age[sink] == unreached) continue;
            const std::vector<Flicks> to_sink = ages_to(plan, static_cast<int>(sink));
            for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
                if (from.age[n] == unreached || to_sink[n] == unreached) continue;
                for (const auto& [name, param] : plan.nodes[n].params) {
                    if (!is_felt(*param)) continue;
                    const double scale = scales.of(n);
                    SourceLocation where = plan.nodes[n].where;
                    for (const OptionText& given : plan.patch.nodes[n].settings)
                        if (given.name == name) where = given.where;
                    felt.push_back({plan.nodes[n].name + "." + name, where, param, static_cast<int>(n),
                                    static_cast<int>(sink), scale * scale * device_scale(plan.nodes[n]),
                                    driven.contains(param)});
                }
            }
        }
    }
    return felt;
}

std::vector<bool> between_hand_and_force(const compile::Schedule& plan) {
    std::vector<bool> is_between(plan.nodes.size(), false);
    for (std::size_t source = 0; source < plan.nodes.size(); ++source) {
        if (plan.nodes[source].type->role != NodeRole::hand_source) continue;
        const Ages from = ages_from(plan, static_cast<int>(source));
        for (std::size_t sink = 0; sink < plan.nodes.size(); ++sink) {
            if (plan.nodes[sink].type->role != NodeRole::hand_sink || from.age[sink] == unreached) continue;
            const std::vector<Flicks> to_sink = ages_to(plan, static_cast<int>(sink));
            for (std::size_t n = 0; n < plan.nodes.size(); ++n)
                if (from.age[n] != unreached && to_sink[n] != unreached) is_between[n] = true;
        }
    }
    return is_between;
}

std::vector<std::string> unstated_laws(const compile::Schedule& plan) {
    const std::vector<bool> is_between = between_hand_and_force(plan);
    const DrivenParams driven = driven_params(plan);
    const Laws laws(plan, driven);
    const std::vector<bool> reached = reached_by_hands(plan);
    std::vector<std::string> names;
    for (std::size_t n = 0; n < plan.nodes.size(); ++n)
        if (is_between[n] && plan.nodes[n].type->shapes_values && !laws.of(n, reached))
            names.push_back(plan.nodes[n].name);
    return names;
}

std::vector<ForceLoop> force_loops(const compile::Schedule& plan,
                                   const std::function<DeviceInfo(const std::string&)>& device_of) {
    const DrivenParams driven = driven_params(plan);
    std::vector<std::pair<std::size_t, DeclaredStiffness>> springs;
    std::vector<std::pair<std::size_t, std::vector<Flicks>>> sinks;  // with the way from each node to it
    const Laws laws(plan, driven);
    const std::vector<bool> reached = reached_by_hands(plan);
    for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
        if (plan.nodes[n].type->role == NodeRole::hand_sink) sinks.emplace_back(n, ages_to(plan, static_cast<int>(n)));
        if (const auto declared = stiffest(driven, plan.nodes[n])) springs.emplace_back(n, *declared);
        if (!plan.nodes[n].type->shapes_values) continue;
        const auto law = laws.of(n, reached);
        if (law && law->newton_per_metre)
            springs.emplace_back(n,
                                 DeclaredStiffness{plan.nodes[n].name + " (its slope)", *law->newton_per_metre, false});
    }

    std::vector<ForceLoop> loops;
    for (std::size_t source = 0; source < plan.nodes.size(); ++source) {
        if (plan.nodes[source].type->role != NodeRole::hand_source) continue;
        const Ages from = ages_from(plan, static_cast<int>(source));
        Scales scales(plan, from);
        for (const auto& at_sink : sinks) {
            const std::size_t sink = at_sink.first;
            const std::vector<Flicks>& to_sink = at_sink.second;
            if (from.age[sink] == unreached) continue;
            const double period = seconds(plan.groups[static_cast<std::size_t>(plan.nodes[sink].group)].period);
            const DeviceInfo pushed = device_of(setting_of(plan, sink, "device"));
            const double source_delay = device_of(setting_of(plan, source, "device")).delay,
                         b = damping_with_hand(pushed), most = pushed.max_stiffness;
            const auto loop_of = [&](Flicks latency, std::optional<DeclaredStiffness> declared) {
                const double delay = loop_delay(seconds(latency), source_delay, pushed.delay);
                return ForceLoop{plan.nodes[source].name,
                                 plan.nodes[sink].name,
                                 seconds(latency),
                                 delay,
                                 period,
                                 b,
                                 pushed.damping > 0.0,
                                 stiffness_limit(b, period, delay),
                                 most,
                                 std::move(declared)};
            };
            std::optional<ForceLoop> worst;
            for (const auto& [spring, declared] : springs) {
                const Flicks there = from.age[spring], back = to_sink[spring];
                if (there == unreached || back == unreached) continue;
                const double scale = scales.of(spring);
                DeclaredStiffness felt{declared.param, declared.newton_per_metre * scale * scale, declared.is_driven};
                if (felt.is_driven && most > 0.0) felt.newton_per_metre = std::min(felt.newton_per_metre, most);
                ForceLoop loop = loop_of(there + back, std::move(felt));
                // Stiffness times delay: the loop with the largest product is nearest to its limit, whatever the damping.
                const auto strain = [period](const ForceLoop& l) {
                    return l.declared->newton_per_metre * (0.5 * period + l.latency_s);
                };
                if (!worst || strain(loop) > strain(*worst)) worst = std::move(loop);
            }
            loops.push_back(worst ? std::move(*worst) : loop_of(from.age[sink], std::nullopt));
        }
    }
    std::ranges::sort(
        loops, [](const ForceLoop& a, const ForceLoop& b) { return std::tie(a.from, a.to) < std::tie(b.from, b.to); });
    return loops;
}

}  // namespace tactus::analyse

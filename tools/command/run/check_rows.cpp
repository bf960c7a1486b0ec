// SPDX-License-Identifier: Apache-2.0
#include "tools/command/run/check_rows.hpp"

#include "assets/file/json.hpp"
#include "devices/audio/portaudio.hpp"
#include "engine/io/host.hpp"
#include "graph/analyse/latency.hpp"
#include "graph/compile/sounds.hpp"
#include "nodes/device/cap_settings.hpp"
#include "tools/command/run/check_process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace tactus::command {

using file::Json;

namespace {

/// Figures of a loop through a hand; "ok" is null when the verdict is unknown.
void add_stiffness(Json& row, const analyse::ForceLoop& loop) {
    const analyse::Verdict verdict = loop.verdict();
    row["latency_ms"] = loop.latency_s * 1e3;
    row["damping_N_s_per_m"] = loop.damping;
    row["stiffness_limit_N_per_mm"] = loop.limit * 1e-3;
    row["max_stiffness_N_per_mm"] = loop.max_stiffness > 0.0 ? Json(loop.max_stiffness * 1e-3) : Json();
    row["declared_N_per_mm"] = loop.declared ? Json(loop.declared->newton_per_metre * 1e-3) : Json();
    row["declared_by"] = loop.declared ? Json(loop.declared->param) : Json();
    row["ok"] = verdict == analyse::Verdict::unknown ? Json() : Json(verdict == analyse::Verdict::stable);
}

Json processes_json(const std::vector<DeviceProcess>& processes) {
    Json rows = Json::array();
    for (const DeviceProcess& process : processes)
        rows.push_back(
            {{"device", process.device}, {"rate_hz", process.rate_hz}, {"added_latency_ms", process.added_s * 1e3}});
    return rows;
}

}  // namespace

Json paths_json(const compile::Schedule& plan, const std::vector<analyse::ForceLoop>& loops) {
    std::map<std::pair<std::string_view, std::string_view>, const analyse::ForceLoop*> by_ends;
    for (const analyse::ForceLoop& loop : loops)
        by_ends.emplace(std::pair<std::string_view, std::string_view>(loop.from, loop.to), &loop);
    Json paths = Json::array();
    for (const analyse::PathLatency& path : analyse::path_latencies(plan)) {
        Json row{{"from", path.from}, {"to", path.to}, {"latency_ms", path.latency_ms}, {"via", path.via}};
        if (const auto found = by_ends.find({path.from, path.to}); found != by_ends.end()) {
            add_stiffness(row, *found->second);
        }
        paths.push_back(std::move(row));
    }
    return paths;
}

Json sound_json(const compile::Schedule& plan) {
    const bool plays = std::ranges::any_of(
        plan.nodes, [](const compile::ScheduleNode& node) { return node.type->role == NodeRole::sound_sink; });
    const bool hears = std::ranges::any_of(
        plan.nodes, [](const compile::ScheduleNode& node) { return compile::sound_source(node).has_value(); });
    if (!plays && !hears) return {};
    Json json{{"buffer_ms", 1e3 * io::AudioChoice{}.margin_s},
              {"card", nullptr},
              {"card_ms", nullptr},
              {"plays", plays},
              {"hears", hears}};
    try {
        for (const audio::AudioCard& card : audio::list_audio_cards())
            if (card.is_default) {
                json["card"] = card.name;
                json["card_ms"] = 1e3 * card.latency;
            }
    } catch (const Error&) {
        // Without a sound system there is no card.
    }
    return json;
}

Json check_json(const std::optional<compile::Schedule>& plan, const patch::Problems& problems) {
    Json json{{"ok", problems.empty()}, {"errors", Json::array()}, {"groups", Json::array()}, {"paths", Json::array()}};
    for (const Error& error : problems.list)
        json["errors"].push_back({{"file", error.where().file},
                                  {"line", error.where().line},
                                  {"column", error.where().column},
                                  {"message", error.message()}});
    if (!plan) return json;
    for (const compile::ScheduleGroup& group : plan->groups) {
        Json nodes = Json::array();
        for (const int node : group.order) nodes.push_back(plan->nodes[static_cast<std::size_t>(node)].name);
        json["groups"].push_back({{"name", group.name},
                                  {"rate_hz", rate_of(group.period)},
                                  {"latency_ms", seconds(group.latency) * 1e3},
                                  {"nodes", nodes}});
    }
    json["paths"] = paths_json(*plan, {});
    json["processes"] = processes_json(device_processes(*plan));
    return json;
}

Json loops_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes) {
    Json loops = Json::array();
    for (const auto& node : nodes) {
        if (node->type->name != "admittance_controller") continue;
        Report report;
        node->type->report(node->instance.get(), report);
        const auto number = [&](const char* key) { return std::get<double>(report.sections.at(node->name).at(key)); };
        loops.push_back({{"node", node->name},
                         {"gain_per_s", number("gain_per_s")},
                         {"gain_limit_per_s", number("gain_limit_per_s")},
                         {"hand_stiffness_N_per_mm", node->params.at("hand_stiffness")->value * 1e-3},
                         {"ok", number("gain_per_s") < number("gain_limit_per_s")}});
    }
    return loops;
}

/// What the energy cap of a device_output bounds, J: its largest force at the stiffness that its loops declare.
static double energy_bound(const build::LiveNode& node, const std::vector<analyse::ForceLoop>& loops) {
    double stiffness = 0.0;
    for (const analyse::ForceLoop& loop : loops)
        if (loop.to == node.name)
            stiffness = std::max(
                stiffness, loop.declared ? loop.declared->newton_per_metre : std::numeric_limits<double>::infinity());
    const build::DeviceSlot& slot = *node.uses.devices.front().first;
    const double stated = slot.port.info.max_force, given = node.params.at("max_force")->value;
    return control::EnergyCap::max_gain(nodes::cap_settings(slot.port.info, seconds(slot.period)), stiffness,
                                        stated > 0.0 ? std::min(stated, given) : given);
}

Json outputs_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes,
                  const std::vector<analyse::ForceLoop>& loops, Json& warnings) {
    Json outputs = Json::array();
    for (const auto& node : nodes) {
        if (node->type->name != "device_output") continue;
        Report report;
        node->type->report(node->instance.get(), report);
        const std::string& cap = std::get<std::string>(report.sections.at("force").at("energy_cap"));
        const bool is_on = cap == "on";
        outputs.push_back({{"node", node->name},
                           {"energy_cap", is_on},
                           {"energy_bound_mJ", is_on ? Json(1e3 * energy_bound(*node, loops)) : Json()}});
        if (cap == "off")
            warnings.push_back(fmt::format(
                "{}: the energy cap is off; contacts may return more energy than the hand has put in", node->name));
    }
    return outputs;
}

Json z_width_json(const std::vector<analysis::ZWidthCurve>& curves) {
    const auto n_mm = [](double value) { return std::isfinite(value) ? Json(value * 1e-3) : Json(); };
    Json rows = Json::array();
    for (const analysis::ZWidthCurve& curve : curves)
        for (const analysis::ZWidthPoint& point : curve.points)
            rows.push_back({{"device", curve.device},
                            {"rate_hz", curve.rate},
                            {"delay_ms", curve.delay * 1e3},
                            {"damping_N_s_per_m", point.damping},
                            {"bound_N_per_mm", n_mm(point.bound)},
                            {"passive_N_per_mm", n_mm(point.passive)},
                            {"friction_N_per_mm", n_mm(point.friction)},
                            {"simulated_N_per_mm", n_mm(point.simulated.stiffness)},
                            {"simulated_press_N", point.simulated.press},
                            {"simulated_approach_m_per_s", point.simulated.approach}});
    return rows;
}

Json contact_json(const std::vector<analysis::NodeContactLaw>& laws) {
    Json rows = Json::array();
    for (const analysis::NodeContactLaw& law : laws) {
        Json row{{"node", law.node}, {"law", law.by_point ? "point" : "area"}};
        if (law.by_point) row["stiffness_N_per_mm_per_point"] = law.stiffness * 1e-3;
        else row["stiffness_N_per_mm_per_mm2"] = law.stiffness * 1e-9;
        row["is_felt"] = law.is_felt;
        row["felt_at_most_N_per_mm"] = law.felt ? Json(*law.felt * 1e-3) : Json();
        rows.push_back(std::move(row));
    }
    return rows;
}

Json classes_json(const std::vector<analysis::ClassVerdict>& verdicts) {
    Json rows = Json::array();
    for (const analysis::ClassVerdict& v : verdicts)
        rows.push_back({{"from", v.from},
                        {"to", v.to},
                        {"class", v.device.name},
                        {"assumed_damping_N_s_per_m", v.device.damping},
                        {"assumed_delay_ms", v.device.delay * 1e3},
                        {"may_feel_N_per_mm", v.may_feel * 1e-3},
                        {"ok", v.ok}});
    return rows;
}

bool is_stable(const Json& json) {
    for (const char* key : {"paths", "admittance_loops"})
        if (json.contains(key))
            for (const Json& row : json[key])
                if (row.contains("ok") && row["ok"] == false) return false;
    return true;
}

bool is_unknown(const Json& json) {
    return json.contains("paths") && std::ranges::any_of(json["paths"], [](const Json& row) {
               return row.contains("ok") && row["ok"].is_null();
           });
}

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/latency.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/run/check_process.hpp"
#include "tools/exit_code.hpp"
#include "tools/picture/report/comparison_figure.hpp"
#include "tools/picture/report/z_width_figure.hpp"
#include "tools/session/load_plan.hpp"
#include "tools/study/passivity/z_width.hpp"
#include "tools/study/patch_stiffness.hpp"

#include "engine/run/engine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::command {

using Json = nlohmann::ordered_json;

namespace {

struct CheckChoice {
    session::PatchChoice patch;
    bool json = false, z_width = false;
    std::string z_width_figure;
};

/// What a loop through a hand says; "ok" is null when the device states no damping.
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

/// One row per path; loops through a hand also have a stiffness.
Json paths_json(const compile::Plan& plan, const std::vector<analyse::ForceLoop>& loops) {
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

Json processes_json(const std::vector<DeviceProcess>& processes) {
    Json rows = Json::array();
    for (const DeviceProcess& process : processes)
        rows.push_back(
            {{"device", process.device}, {"rate_hz", process.rate_hz}, {"added_latency_ms", process.added_s * 1e3}});
    return rows;
}

void print_processes(const Json& processes) {
    for (const Json& process : processes)
        fmt::print("device '{}' has a process of its own at {:.4g} Hz, which makes its force up to {:.4g} ms later\n",
                   process["device"].get<std::string>(), process["rate_hz"].get<double>(),
                   process["added_latency_ms"].get<double>());
}

Json check_json(const std::optional<compile::Plan>& plan, const patch::Problems& problems) {
    Json json{{"ok", problems.empty()}, {"errors", Json::array()}, {"groups", Json::array()}, {"paths", Json::array()}};
    for (const Error& error : problems.list)
        json["errors"].push_back({{"file", error.where().file},
                                  {"line", error.where().line},
                                  {"column", error.where().column},
                                  {"message", error.message()}});
    if (!plan) return json;
    for (const compile::PlanGroup& group : plan->groups) {
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

/// The position loops of admittance controllers: gain and stability limit.
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

/// The outputs to a hand, and which of them may return more energy than the hand has put in.
Json outputs_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes, Json& warnings) {
    Json outputs = Json::array();
    for (const auto& node : nodes) {
        if (node->type->name != "device_output") continue;
        Report report;
        node->type->report(node->instance.get(), report);
        const bool is_on = std::get<std::string>(report.sections.at("force").at("energy_cap")) == "on";
        outputs.push_back({{"node", node->name}, {"energy_cap", is_on}});
        if (!is_on)
            warnings.push_back(fmt::format(
                "{}: the energy cap is off; contacts may return more energy than the hand has put in", node->name));
    }
    return outputs;
}

/// What a device, by its name in the patch, states; "" is the only one; 0: nothing.
std::function<double(const std::string&)> stated_by(const io::EngineHost& host, double DeviceInfo::* number) {
    return [&host, number](const std::string& name) {
        for (const auto& slot : host.devices)
            if (name.empty() || slot->name == name) return slot->port.info.*number;
        return 0.0;
    };
}

/// Of each device that a node drives, as an ideal one, and of the simulated devices.
std::vector<study::ZWidthCurve> z_width_of(const io::EngineHost& host) {
    study::ZWidthGrid grid;
    std::vector<study::ZWidthDevice> devices;
    for (const auto& slot : host.devices) {
        if (slot->port.info.fingers > 0) continue;
        devices.push_back(study::ideal_device(slot->name + ", ideal", slot->port.info));
        const double rate = rate_of(slot->period);
        if (std::ranges::find(grid.rates, rate) == grid.rates.end()) grid.rates.push_back(rate);
    }
    std::ranges::sort(grid.rates);
    for (study::ZWidthDevice& device : study::modelled_devices()) devices.push_back(std::move(device));
    return study::z_width(devices, grid);
}

Json z_width_json(const std::vector<study::ZWidthCurve>& curves) {
    const auto n_mm = [](double value) { return std::isfinite(value) ? Json(value * 1e-3) : Json(); };
    Json rows = Json::array();
    for (const study::ZWidthCurve& curve : curves)
        for (const study::ZWidthPoint& point : curve.points)
            rows.push_back({{"device", curve.device},
                            {"rate_hz", curve.rate},
                            {"delay_ms", curve.delay * 1e3},
                            {"damping_N_s_per_m", point.damping},
                            {"bound_N_per_mm", n_mm(point.bound)},
                            {"passive_N_per_mm", n_mm(point.passive)},
                            {"friction_N_per_mm", n_mm(point.friction)},
                            {"simulated_N_per_mm", n_mm(point.simulated)}});
    return rows;
}

void print_z_width(const Json& rows) {
    fmt::print("\n{:<24} {:>7} {:>9} {:>12} {:>10} {:>10} {:>10} {:>12}\n", "wall: device", "rate", "delay", "damping",
               "bound", "passive", "friction", "simulated");
    for (const Json& row : rows) {
        const auto cell = [&](const char* key) {
            return row[key].is_null() ? std::string("-") : fmt::format("{:.3g}", row[key].get<double>());
        };
        fmt::print("{:<24} {:>4g} Hz {:>6.3g} ms {:>6g} N s/m {:>10} {:>10} {:>10} {:>12}\n",
                   row["device"].get<std::string>(), row["rate_hz"].get<double>(), row["delay_ms"].get<double>(),
                   row["damping_N_s_per_m"].get<double>(), cell("bound_N_per_mm"), cell("passive_N_per_mm"),
                   cell("friction_N_per_mm"), cell("simulated_N_per_mm"));
    }
    fmt::print(
        "Stiffness in N/mm. bound: (b - |B|) / (T / 2 + delay), Colgate and Schenkel; passive: the same by motion; "
        "friction: up to which Coulomb friction takes what encoder steps give; simulated: the device, leaned on "
        "with 1 N, begins to oscillate.\n");
}

/// By which law each node's bodies touch.
Json contact_json(const std::vector<study::NodeContactLaw>& laws) {
    Json rows = Json::array();
    for (const study::NodeContactLaw& law : laws) {
        Json row{{"node", law.node}, {"law", law.by_point ? "point" : "area"}};
        if (law.by_point) row["stiffness_N_per_mm_per_point"] = law.stiffness * 1e-3;
        else row["stiffness_N_per_mm_per_mm2"] = law.stiffness * 1e-9;
        row["felt_at_most_N_per_mm"] = law.felt ? Json(*law.felt * 1e-3) : Json();
        rows.push_back(std::move(row));
    }
    return rows;
}

Json classes_json(const std::vector<study::ClassVerdict>& verdicts) {
    Json rows = Json::array();
    for (const study::ClassVerdict& v : verdicts)
        rows.push_back({{"from", v.from},
                        {"to", v.to},
                        {"class", v.device.name},
                        {"assumed_damping_N_s_per_m", v.device.damping},
                        {"may_feel_N_per_mm", v.may_feel * 1e-3},
                        {"ok", v.ok}});
    return rows;
}

void print_contact(const Json& laws) {
    if (laws.empty()) return;
    fmt::print("\n{:<20} {:<36} {}\n", "contact", "law", "a hand feels at most");
    for (const Json& row : laws) {
        const std::string law =
            row["law"] == "point"
                ? fmt::format("per point: {:.4g} N/mm for each", row["stiffness_N_per_mm_per_point"].get<double>())
                : fmt::format("per area: {:.4g} N/mm for each mm^2", row["stiffness_N_per_mm_per_mm2"].get<double>());
        const Json& felt = row["felt_at_most_N_per_mm"];
        fmt::print("{:<20} {:<36} {}\n", row["node"].get<std::string>(), law,
                   felt.is_null() ? std::string("all of it, unless a node after it takes less")
                                  : fmt::format("{:.4g} N/mm, its spring", felt.get<double>()));
    }
}

void print_classes(const Json& classes) {
    if (classes.empty()) return;
    fmt::print("\n{:<38} {:<28} {:>12} {:>12}\n", "with another device", "path", "damping", "may feel");
    for (const Json& row : classes)
        fmt::print("{:<38} {:<28} {:>6.3g} N s/m {:>7.3g} N/mm{}\n", row["class"].get<std::string>(),
                   row["from"].get<std::string>() + " -> " + row["to"].get<std::string>(),
                   row["assumed_damping_N_s_per_m"].get<double>(), row["may_feel_N_per_mm"].get<double>(),
                   row["ok"].get<bool>() ? "" : "  TOO STIFF");
    fmt::print("Makers state no damping: it is assumed, with a light grip. Stiffness as makers state it.\n");
}

/// The part of a path's line after its latency.
std::string stiffness_text(const Json& row) {
    if (!row.contains("ok")) return {};
    const double limit = row["stiffness_limit_N_per_mm"];
    std::string text = limit > 0.0 ? fmt::format(" {:>7.3g} N/mm", limit) : fmt::format(" {:>12}", "unknown");
    if (row["declared_by"].is_null()) return text;
    const double declared = row["declared_N_per_mm"];
    text += fmt::format(" {:>7.3g} N/mm  {}", declared, row["declared_by"].get<std::string>());
    const Json& most = row["max_stiffness_N_per_mm"];
    if (!most.is_null() && declared > most.get<double>())
        text += fmt::format("  TOO STIFF: the device states {:.3g} N/mm", most.get<double>());
    else if (row["ok"].is_null()) text += "  UNKNOWN: the device states no damping";
    else if (!row["ok"].get<bool>()) text += "  TOO STIFF";
    return text;
}

void print_loops(const Json& loops) {
    fmt::print("\n{:<32} {:>12} {:>12}\n", "admittance loop", "gain", "unstable from");
    for (const Json& loop : loops)
        fmt::print("{:<32} {:>8.4g} 1/s {:>8.4g} 1/s  in a hand of {:.3g} N/mm{}\n", loop["node"].get<std::string>(),
                   loop["gain_per_s"].get<double>(), loop["gain_limit_per_s"].get<double>(),
                   loop["hand_stiffness_N_per_mm"].get<double>(), loop["ok"] ? "" : "  UNSTABLE");
}

void print_check(const Json& json) {
    for (const Json& group : json["groups"])
        fmt::print("{:>10}  latency {:.4g} ms  {} nodes\n", group["name"].get<std::string>(),
                   group["latency_ms"].get<double>(), group["nodes"].size());
    if (json.contains("processes")) print_processes(json["processes"]);
    if (json["paths"].empty()) return;
    fmt::print("\n{:<32} {:>10} {:>12} {:>12}\n", "path", "latency", "may feel", "declared");
    for (const Json& path : json["paths"]) {
        std::string line =
            fmt::format("{:<32} {:>7.4g} ms", path["from"].get<std::string>() + " -> " + path["to"].get<std::string>(),
                        path["latency_ms"].get<double>());
        line += stiffness_text(path);
        fmt::print("{}\n", line);
    }
    fmt::print("Limit of stable stiffness: damping of the device / (period / 2 + latency).\n");
    if (json.contains("contact")) print_contact(json["contact"]);
    if (json.contains("device_classes")) print_classes(json["device_classes"]);
}

/// True when no path exceeds its stiffness limit and no loop is unstable.
bool is_stable(const Json& json) {
    for (const char* key : {"paths", "admittance_loops"})
        if (json.contains(key))
            for (const Json& row : json[key])
                if (row.contains("ok") && row["ok"] == false) return false;
    return true;
}

/// A stiffness could not be judged.
bool is_unknown(const Json& json) {
    return json.contains("paths") && std::ranges::any_of(json["paths"], [](const Json& row) {
               return row.contains("ok") && row["ok"].is_null();
           });
}

const char* verdict_text(const Json& json) {
    if (!is_stable(json)) return "no errors, but a path is too stiff or a loop unstable";
    return is_unknown(json) ? "no errors, but whether a path is too stiff is unknown: its device states no damping"
                            : "no errors";
}

int check(const CheckChoice& choice) {
    patch::Problems problems;
    compile::AssetCache assets;
    std::optional<compile::Plan> plan;
    Json json;
    try {
        plan = session::read_plan(choice.patch, problems);
        if (plan) assets.load(*plan, problems);
        json = check_json(plan, problems);
        // Finds errors that only `prepare` can find: devices, file names, sizes.
        if (problems.empty()) {
            run::EngineOptions options;
            options.limits_stiffness = false;
            const run::Engine engine(std::move(*plan), options);
            auto loops = analyse::force_loops(engine.plan(), stated_by(engine.host(), &DeviceInfo::damping),
                                              stated_by(engine.host(), &DeviceInfo::max_stiffness));
            add_process_delay(loops, engine.plan());
            json["paths"] = paths_json(engine.plan(), loops);
            json["contact"] = contact_json(study::contact_laws(engine.nodes()));
            json["device_classes"] = classes_json(study::class_verdicts(loops));
            json["admittance_loops"] = loops_json(engine.nodes());
            json["warnings"] = engine.host().notices;
            json["outputs"] = outputs_json(engine.nodes(), json["warnings"]);
            if (choice.z_width || !choice.z_width_figure.empty()) {
                const std::vector<study::ZWidthCurve> curves = z_width_of(engine.host());
                json["z_width"] = z_width_json(curves);
                if (!choice.z_width_figure.empty())
                    picture::write_figure(picture::draw_z_width(curves), choice.z_width_figure);
            }
        }
    } catch (const Error& error) {
        problems.list.push_back(error);
        const Json before = std::exchange(json, check_json(std::nullopt, problems));
        for (const char* key : {"groups", "processes"})
            if (before.contains(key)) json[key] = before[key];
    }
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else {
        for (const std::string& line : session::problem_lines(problems)) fmt::print(stderr, "{}\n", line);
        print_check(json);
        if (json.contains("admittance_loops") && !json["admittance_loops"].empty())
            print_loops(json["admittance_loops"]);
        if (json.contains("warnings"))
            for (const Json& warning : json["warnings"]) fmt::print("warning: {}\n", warning.get<std::string>());
        if (json.contains("z_width")) print_z_width(json["z_width"]);
        if (problems.empty()) fmt::print("{}\n", verdict_text(json));
    }
    if (!problems.empty()) return bad_input;
    return is_stable(json) ? done : answer_is_no;
}

Action add(VerbOptions& verb) {
    const auto choice = std::make_shared<CheckChoice>();
    add_patch_options(verb, choice->patch);
    verb.flag("--json", choice->json, "as JSON");
    verb.flag(
        "--z-width", choice->z_width,
        "also which walls, by stiffness and damping, the devices of the patch and simulated ones bear, per rate and "
        "delay");
    verb.add("--z-width-figure", choice->z_width_figure, "draw that to this .svg or .png");
    return [choice] { return check(*choice); };
}

}  // namespace

Verb check_verb() {
    return {"check", "find errors; list groups, latencies and stiffness limits; exit code 1: too stiff or unstable",
            add};
}

}  // namespace tactus::command

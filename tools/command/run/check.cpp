// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/latency.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/command/patch_options.hpp"
#include "tools/command/run/check_process.hpp"
#include "tools/exit_code.hpp"
#include "tools/session/load_plan.hpp"

#include "engine/run/engine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <memory>
#include <string_view>
#include <utility>

namespace tactus::command {

using Json = nlohmann::ordered_json;

namespace {

struct CheckChoice {
    session::PatchChoice patch;
    bool json = false;
};

/// One row per path; a loop through a hand has its stiffness too.
Json paths_json(const compile::Plan& plan, const std::vector<analyse::ForceLoop>& loops) {
    std::map<std::pair<std::string_view, std::string_view>, const analyse::ForceLoop*> by_ends;
    for (const analyse::ForceLoop& loop : loops)
        by_ends.emplace(std::pair<std::string_view, std::string_view>(loop.from, loop.to), &loop);
    Json paths = Json::array();
    for (const analyse::PathLatency& path : analyse::path_latencies(plan)) {
        Json row{{"from", path.from}, {"to", path.to}, {"latency_ms", path.latency_ms}, {"via", path.via}};
        if (const auto found = by_ends.find({path.from, path.to}); found != by_ends.end()) {
            const analyse::ForceLoop& loop = *found->second;
            row["latency_ms"] = loop.latency_s * 1e3;
            row["damping_N_s_per_m"] = loop.damping;
            row["stiffness_limit_N_per_mm"] = loop.limit * 1e-3;
            row["declared_N_per_mm"] = loop.declared ? Json(loop.declared->newton_per_metre * 1e-3) : Json();
            row["declared_by"] = loop.declared ? Json(loop.declared->param) : Json();
            row["ok"] = loop.ok();
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

/// The position loops of admittance controllers: their gain, and from which on they would be unstable.
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

/// Damping of a device by its name in the patch, N·s/m; "" is the only one.
std::function<double(const std::string&)> damping_of(const io::EngineHost& host) {
    return [&host](const std::string& name) {
        for (const auto& slot : host.devices)
            if (name.empty() || slot->name == name) return slot->port.info.damping;
        return 0.0;
    };
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
        if (path.contains("ok")) {
            const double limit = path["stiffness_limit_N_per_mm"];
            line += limit > 0.0 ? fmt::format(" {:>7.3g} N/mm", limit) : fmt::format(" {:>12}", "?");
            if (!path["declared_by"].is_null())
                line += fmt::format(" {:>7.3g} N/mm  {}{}", path["declared_N_per_mm"].get<double>(),
                                    path["declared_by"].get<std::string>(), path["ok"] ? "" : "  TOO STIFF");
        }
        fmt::print("{}\n", line);
    }
    fmt::print("What a hand may feel before it hums: damping of the device / (period / 2 + latency).\n");
}

/// No path is stiffer than a hand may feel it, and no loop unstable.
bool is_stable(const Json& json) {
    for (const char* key : {"paths", "admittance_loops"})
        if (json.contains(key))
            for (const Json& row : json[key])
                if (row.contains("ok") && !row["ok"].get<bool>()) return false;
    return true;
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
        // What only `prepare` can find: devices, file names, sizes.
        if (problems.empty()) {
            const run::Engine engine(std::move(*plan), run::EngineOptions{});
            auto loops = analyse::force_loops(engine.plan(), damping_of(engine.host()));
            add_process_delay(loops, engine.plan());
            json["paths"] = paths_json(engine.plan(), loops);
            json["admittance_loops"] = loops_json(engine.nodes());
            json["warnings"] = engine.host().notices;
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
        if (problems.empty())
            fmt::print("{}\n", is_stable(json) ? "no errors" : "no errors, but a path is too stiff or a loop unstable");
    }
    if (!problems.empty()) return bad_input;
    return is_stable(json) ? done : answer_is_no;
}

Action add(VerbOptions& verb) {
    const auto choice = std::make_shared<CheckChoice>();
    add_patch_options(verb, choice->patch);
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return check(*choice); };
}

}  // namespace

Verb check_verb() {
    return {"check", "find errors; list groups, latencies and stiffness limits; exit code 1: too stiff or unstable",
            add};
}

}  // namespace tactus::command

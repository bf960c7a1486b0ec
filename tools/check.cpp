// SPDX-License-Identifier: Apache-2.0
#include "graph/draw.hpp"
#include "graph/latency.hpp"
#include "tools/load_plan.hpp"
#include "tools/summary.hpp"

#include "engine/engine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tactus {

using Json = nlohmann::ordered_json;

namespace {

Json check_json(const std::optional<Plan>& plan, const Problems& problems) {
    Json json{{"ok", problems.empty()}, {"errors", Json::array()}, {"groups", Json::array()}, {"paths", Json::array()}};
    for (const Error& error : problems.list)
        json["errors"].push_back({{"file", error.where().file},
                                  {"line", error.where().line},
                                  {"column", error.where().column},
                                  {"message", error.message()}});
    if (!plan) return json;
    for (const PlanGroup& group : plan->groups) {
        Json nodes = Json::array();
        for (const int node : group.order) nodes.push_back(plan->nodes[static_cast<std::size_t>(node)].name);
        json["groups"].push_back({{"name", group.name},
                                  {"rate_hz", rate_of(group.period)},
                                  {"latency_ms", seconds(group.latency) * 1e3},
                                  {"nodes", nodes}});
    }
    for (const PathLatency& path : path_latencies(*plan))
        json["paths"].push_back(
            {{"from", path.from}, {"to", path.to}, {"latency_ms", path.latency_ms}, {"via", path.via}});
    return json;
}

void print_check(const Json& json) {
    for (const Json& group : json["groups"])
        fmt::print("{:>10}  latency {:.4g} ms  {} nodes\n", group["name"].get<std::string>(),
                   group["latency_ms"].get<double>(), group["nodes"].size());
    for (const Json& path : json["paths"])
        fmt::print("{} -> {}: {:.4g} ms\n", path["from"].get<std::string>(), path["to"].get<std::string>(),
                   path["latency_ms"].get<double>());
}

}  // namespace

int check_verb(const PatchChoice& choice) {
    Problems problems;
    AssetCache assets;
    std::optional<Plan> plan;
    Json json;
    try {
        plan = read_plan(choice, problems);
        if (plan) assets.load(*plan, problems);
        json = check_json(plan, problems);
        // What only `prepare` can find: devices, file names, sizes.
        if (problems.empty()) Engine(std::move(*plan), EngineOptions{});
    } catch (const Error& error) {
        problems.list.push_back(error);
        const Json groups = json.is_null() ? Json::array() : json["groups"];
        json = check_json(std::nullopt, problems);
        json["groups"] = groups;
    }
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else {
        for (const Error& error : problems.list) fmt::print(stderr, "{}\n", error.what());
        print_check(json);
        if (problems.empty()) fmt::print("no errors\n");
    }
    return problems.empty() ? done : bad_input;
}

int draw_verb(const PatchChoice& choice, const std::filesystem::path& out) {
    Problems problems;
    const std::optional<Plan> plan = read_plan(choice, problems);
    if (!plan) {
        for (std::size_t i = 0; i + 1 < problems.list.size(); ++i)
            fmt::print(stderr, "tactus: {}\n", problems.list[i].what());
        throw problems.list.back();
    }
    const std::string svg = draw_svg(*plan);
    if (out.empty()) fmt::print("{}", svg);
    else write_text(out, svg);
    return done;
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
#include "tools/command/run/check_stiffness.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tactus::command {

using Json = nlohmann::ordered_json;

namespace {

Json in_newton_per_mm(double newton_per_metre) {
    return newton_per_metre > 0.0 ? Json(newton_per_metre * 1e-3) : Json();
}

Json ok_of(analyse::Verdict verdict) {
    return verdict == analyse::Verdict::unknown ? Json() : Json(verdict == analyse::Verdict::stable);
}

}  // namespace

void add_stiffness(Json& row, const analyse::ForceLoop& loop) {
    row["latency_ms"] = loop.latency_s * 1e3;
    row["damping_N_s_per_m"] = loop.damping;
    row["stiffness_limit_N_per_mm"] = loop.limit * 1e-3;
    row["max_stiffness_N_per_mm"] = in_newton_per_mm(loop.max_stiffness);
    row["declared_N_per_mm"] = loop.declared ? Json(loop.declared->newton_per_metre * 1e-3) : Json();
    row["declared_by"] = loop.declared ? Json(loop.declared->param) : Json();
    row["ok"] = ok_of(loop.verdict());
}

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

Json contact_laws_json(const std::vector<std::shared_ptr<build::LiveNode>>& nodes) {
    Json laws = Json::array();
    for (const auto& node : nodes) {
        const auto area = node->params.find("area_stiffness"), point = node->params.find("point_stiffness");
        if (area == node->params.end() || point == node->params.end()) continue;
        const bool by_point = point->second->value > 0.0;
        Json row{{"node", node->name}, {"law", by_point ? "point" : "area"}};
        if (by_point) row["stiffness_N_per_mm_per_point"] = point->second->value * 1e-3;
        else row["stiffness_N_per_mm_per_mm2"] = area->second->value * 1e-9;
        const auto spring = node->params.find("stiffness");
        row["felt_at_most_N_per_mm"] = spring != node->params.end() ? Json(spring->second->value * 1e-3) : Json();
        laws.push_back(std::move(row));
    }
    return laws;
}

void print_contact_laws(const Json& laws) {
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

Json device_classes_json(const std::vector<analyse::ForceLoop>& loops) {
    Json rows = Json::array();
    for (const analyse::ForceLoop& loop : loops) {
        if (!loop.declared) continue;
        for (const analyse::DeviceClass& kind : analyse::device_classes()) {
            analyse::ForceLoop with = loop;
            with.damping = kind.damping;
            with.limit = analyse::stiffness_limit(kind.damping, loop.period_s, loop.latency_s);
            with.max_stiffness = kind.max_stiffness;
            rows.push_back({{"from", loop.from},
                            {"to", loop.to},
                            {"class", kind.name},
                            {"assumed_damping_N_s_per_m", kind.damping},
                            {"may_feel_N_per_mm", std::min(with.limit, with.max_stiffness) * 1e-3},
                            {"ok", with.ok()}});
        }
    }
    return rows;
}

void print_device_classes(const Json& classes) {
    if (classes.empty()) return;
    fmt::print("\n{:<38} {:<28} {:>12} {:>12}\n", "with another device", "path", "damping", "may feel");
    for (const Json& row : classes)
        fmt::print("{:<38} {:<28} {:>6.3g} N s/m {:>7.3g} N/mm{}\n", row["class"].get<std::string>(),
                   row["from"].get<std::string>() + " -> " + row["to"].get<std::string>(),
                   row["assumed_damping_N_s_per_m"].get<double>(), row["may_feel_N_per_mm"].get<double>(),
                   row["ok"].get<bool>() ? "" : "  TOO STIFF");
    fmt::print("Makers state no damping: it is assumed, with a light grip. Stiffness as makers state it.\n");
}

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
#include "tools/command/run/check_text.hpp"

#include "assets/file/json.hpp"
#include "tools/command/run/check_rows.hpp"
#include "tools/command/run/check_schedule.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

#include <string>

namespace tactus::command {

using file::Json;

namespace {

void print_processes(const Json& processes) {
    for (const Json& process : processes)
        fmt::print("device '{}' has a process of its own at {:.4g} Hz, which makes its force up to {:.4g} ms later\n",
                   process["device"].get<std::string>(), process["rate_hz"].get<double>(),
                   process["added_latency_ms"].get<double>());
}

void print_z_width(const Json& rows) {
    fmt::print("\n{:<24} {:>7} {:>9} {:>12} {:>10} {:>10} {:>10} {:>12} {:>10}\n", "wall: device", "rate", "delay",
               "damping", "bound", "passive", "friction", "simulated", "at press");
    for (const Json& row : rows) {
        const auto cell = [&](const char* key) {
            return row[key].is_null() ? std::string("-") : fmt::format("{:.3g}", row[key].get<double>());
        };
        fmt::print("{:<24} {:>4g} Hz {:>6.3g} ms {:>6g} N s/m {:>10} {:>10} {:>10} {:>12} {:>8.2g} N\n",
                   row["device"].get<std::string>(), row["rate_hz"].get<double>(), row["delay_ms"].get<double>(),
                   row["damping_N_s_per_m"].get<double>(), cell("bound_N_per_mm"), cell("passive_N_per_mm"),
                   cell("friction_N_per_mm"), cell("simulated_N_per_mm"), row["simulated_press_N"].get<double>());
    }
    fmt::print(
        "Stiffness in N/mm. bound: (b - |B|) / (T / 2 + delay), Colgate and Schenkel; passive: the same by motion; "
        "friction: up to which Coulomb friction takes what encoder steps give; simulated: the device begins to "
        "oscillate, at the worst press from 0.5 N to 0.8 of its force and approach up to 0.3 m/s. b includes a hand of "
        "2 N s/m where the device states no damping.\n");
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
                   !row["is_felt"].get<bool>() ? std::string("nothing: no device gets its force")
                   : felt.is_null()            ? std::string("all of it, unless a node after it takes less")
                                               : fmt::format("{:.4g} N/mm, its spring", felt.get<double>()));
    }
}

void print_classes(const Json& classes) {
    if (classes.empty()) return;
    fmt::print(
        "\nFor information, not part of the verdict: the same patch on other devices.\n{:<38} {:<28} {:>12} {:>12}\n",
        "device", "path", "damping", "may feel");
    for (const Json& row : classes)
        fmt::print("{:<38} {:<28} {:>6.3g} N s/m {:>7.3g} N/mm{}\n", row["class"].get<std::string>(),
                   row["from"].get<std::string>() + " -> " + row["to"].get<std::string>(),
                   row["assumed_damping_N_s_per_m"].get<double>(), row["may_feel_N_per_mm"].get<double>(),
                   row["ok"].get<bool>() ? "" : "  would be too stiff");
    fmt::print("Makers state no damping: it is assumed, and a hand adds 2 N s/m. Stiffness as makers state it.\n");
}

/// The part of a path's line after its latency.
std::string stiffness_text(const Json& row) {
    if (!row.contains("ok")) return {};
    const double limit = row["stiffness_limit_N_per_mm"].get<double>();
    std::string text = fmt::format(" {:>7.3g} N/mm", limit);
    if (row["declared_by"].is_null()) return text;
    const double declared = row["declared_N_per_mm"].get<double>();
    text += fmt::format(" {:>7.3g} N/mm  {}", declared, row["declared_by"].get<std::string>());
    const Json& most = row["max_stiffness_N_per_mm"];
    if (!most.is_null() && declared > most.get<double>())
        text += fmt::format("  TOO STIFF: the device states {:.3g} N/mm", most.get<double>());
    else if (row["ok"].is_null()) text += "  UNKNOWN: the device states no damping, and a hand alone damps less";
    else if (!row["ok"].get<bool>()) text += "  TOO STIFF";
    return text;
}

void print_loops(const Json& loops) {
    fmt::print("\n{:<32} {:>12} {:>12}\n", "admittance loop", "gain", "unstable from");
    for (const Json& loop : loops)
        fmt::print("{:<32} {:>8.4g} 1/s {:>8.4g} 1/s  in a hand of {:.3g} N/mm{}\n", loop["node"].get<std::string>(),
                   loop["gain_per_s"].get<double>(), loop["gain_limit_per_s"].get<double>(),
                   loop["hand_stiffness_N_per_mm"].get<double>(), loop["ok"].get<bool>() ? "" : "  UNSTABLE");
}

/// What a sound card adds to the paths that begin or end there.
void print_sound(const Json& sound) {
    if (sound["hears"].get<bool>())
        fmt::print(
            "Hearing: what a card hears waits {:.4g} ms (--audio-margin) and one callback, and as long as the card "
            "itself needs.\n",
            sound["buffer_ms"].get<double>());
    if (!sound["plays"].get<bool>()) return;
    fmt::print("Sound: a run adds the card's buffer, {:.4g} ms (--audio-margin) and one callback, and ",
               sound["buffer_ms"].get<double>());
    if (sound["card"].is_null()) fmt::print("a card's own latency; there is no card here.\n");
    else
        fmt::print("the card's own latency, {:.3g} ms as '{}' states it.\n", sound["card_ms"].get<double>(),
                   sound["card"].get<std::string>());
}

void print_plan(const Json& json) {
    for (const Json& group : json["groups"])
        fmt::print("{:>10}  latency {:.4g} ms  {}\n", group["name"].get<std::string>(),
                   group["latency_ms"].get<double>(), counted(group["nodes"].size(), "node"));
    if (json.contains("schedule")) print_schedule(json["schedule"]);
    if (json.contains("processes")) print_processes(json["processes"]);
    if (json["paths"].empty()) {
        if (json.contains("sound")) print_sound(json["sound"]);
        return;
    }
    fmt::print("\n{:<32} {:>10} {:>12} {:>12}\n", "path, on the patch's device", "latency", "may feel", "declared");
    for (const Json& path : json["paths"]) {
        std::string line =
            fmt::format("{:<32} {:>7.4g} ms", path["from"].get<std::string>() + " -> " + path["to"].get<std::string>(),
                        path["latency_ms"].get<double>());
        line += stiffness_text(path);
        fmt::print("{}\n", line);
    }
    if (json.contains("sound")) print_sound(json["sound"]);
    fmt::print(
        "Limit of stable stiffness: damping of the device with a hand on it / (period / 2 + latency, that of the "
        "device included).\n");
    if (json.contains("outputs"))
        for (const Json& output : json["outputs"])
            if (output["energy_cap"].get<bool>())
                fmt::print(
                    "{}: a contact returns at most {:.3g} mJ beyond 1.05 of what it took, and what a hand damps.\n",
                    output["node"].get<std::string>(), output["energy_bound_mJ"].get<double>());
    if (json.contains("contact")) print_contact(json["contact"]);
    if (json.contains("device_classes")) print_classes(json["device_classes"]);
}

const char* verdict_text(const Json& json) {
    if (!is_stable(json)) return "no errors, but a path is too stiff or a loop unstable";
    return is_unknown(json) ? "no errors, but whether a path is too stiff is unknown: its device states no damping"
                            : "no errors";
}

}  // namespace

void print_check(const Json& found) {
    print_plan(found);
    if (found.contains("admittance_loops") && !found["admittance_loops"].empty())
        print_loops(found["admittance_loops"]);
    if (found.contains("warnings"))
        for (const Json& warning : found["warnings"]) fmt::print("warning: {}\n", warning.get<std::string>());
    if (found.contains("z_width")) print_z_width(found["z_width"]);
    if (found["errors"].empty()) fmt::print("{}\n", verdict_text(found));
}

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
#include "tools/run/summary.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "engine/io/lost_device.hpp"
#include "tools/run/force_news.hpp"
#include "tools/run/force_summary.hpp"
#include "tools/run/live_table.hpp"
#include "tools/run/task_summary.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::run {

using file::Json;

namespace {

Json group_json(const run::GroupRuntime& group, bool live) {
    const observe::GroupTelemetry& t = group.telemetry;
    Json json{{"name", group.plan->name},
              {"rate_hz", rate_of(group.plan->period)},
              {"ticks", t.ticks.load()},
              {"misses", t.misses.load()},
              {"skipped", t.skipped.load()},
              {"dropped", t.dropped.load()},
              {"lost_events", t.lost_events.load()},
              {"execution_us",
               {{"p50", t.execution.quantile_ns(0.5) * 1e-3},
                {"p99", t.execution.quantile_ns(0.99) * 1e-3},
                {"max", static_cast<double>(t.execution.max_ns()) * 1e-3}}}};
    if (live) {
        const auto causes = [](const observe::LateCounts& counts) {
            return Json{{"woken_late", counts[observe::LateCause::woken_late]},
                        {"preempted", counts[observe::LateCause::preempted]},
                        {"ran_long", counts[observe::LateCause::ran_long]}};
        };
        json["skipped_because"] = causes(t.skip_causes);
        json["values_too_late_because"] = causes(t.withheld);
        json["lateness_us"] = {{"p50", t.lateness.quantile_ns(0.5) * 1e-3},
                               {"p99", t.lateness.quantile_ns(0.99) * 1e-3},
                               {"max", static_cast<double>(t.lateness.max_ns()) * 1e-3}};
    }
    return json;
}

Json card_json(const io::SoundCard& card) {
    const AudioStatistics s = card.statistics();
    Json json{{"card", card.name()},
              {"rate_hz", card.rate()},
              {"largest_callback", card.largest_callback()},
              {"frames_written", s.frames_written},
              {"underflows", s.underflows},
              {"frames_underflowed", s.frames_underflowed},
              {"frames_dropped", s.frames_dropped},
              {"frames_left_out", s.frames_left_out},
              {"runs_fast_ppm", 1e6 * card.follower().loop().rate_error()},
              {"losses", card.losses()}};
    if (const io::CardInput* input = card.input())
        json["heard"] = {{"channels", input->channels()},     {"xruns", input->xruns()},
                         {"card_xruns", input->card_xruns()}, {"frames_missed", input->frames_missed()},
                         {"resyncs", input->resyncs()},       {"latency_ms", 1e3 * input->latency_s()}};
    if (card.lost_at()) json["lost_at_s"] = tactus::seconds(*card.lost_at());
    return json;
}

Json value_json(const Report::Value& value) {
    return std::visit([](const auto& v) { return Json(v); }, value);
}

std::vector<double> list_of(const Report& report, const char* section, const char* key) {
    const auto found = report.sections.find(section);
    if (found == report.sections.end()) return {};
    const auto value = found->second.find(key);
    if (value == found->second.end()) return {};
    const auto* list = std::get_if<std::vector<double>>(&value->second);
    return list ? *list : std::vector<double>{};
}

}  // namespace

std::vector<std::string> unrecovered(const run::Engine& engine) {
    std::vector<std::string> lines;
    for (const auto& slot : engine.host().devices)
        if (const control::Fault fault = slot->port.fault;
            fault != control::Fault::none && !control::is_lateness(fault))
            lines.push_back(fmt::format("fault of {} at the end of the run: {}", slot->name, control::describe(fault)));
    for (const auto& slot : engine.host().devices)
        if (const std::string loss = io::loss_of(*slot); !loss.empty())
            lines.push_back(fmt::format("device '{}' was lost: {}", slot->name, loss));
    for (const auto& card : engine.host().cards)
        if (card->is_lost()) lines.push_back(fmt::format("{} was lost", card->name()));
    return lines;
}

std::string summary_json(const run::Engine& engine, const Report& report, double seconds, bool live,
                         const std::vector<std::string>& files, const std::vector<std::string>& losses) {
    Json json{{"patch", engine.plan().patch.title},
              {"seconds", seconds},
              {"live", live},
              {"output_hash", fmt::format("{:016x}", engine.output_hash())},
              {"groups", Json::array()}};
    for (const auto& group : engine.groups()) json["groups"].push_back(group_json(*group, live));
    for (const auto& [section, values] : report.sections)
        for (const auto& [key, value] : values) json[section][key] = value_json(value);
    json["slowest_nodes"] = Json::array();
    for (const NodeTime& node : slowest_nodes(engine, 10))
        json["slowest_nodes"].push_back({{"node", node.node},
                                         {"group", node.group},
                                         {"mean_us", node.mean_us},
                                         {"max_us", node.max_us},
                                         {"share", node.share}});
    json["sound"] = Json::array();
    for (const auto& card : engine.host().cards) json["sound"].push_back(card_json(*card));
    json["faults"] = Json::array();
    for (const auto& slot : engine.host().devices)
        for (const io::DeviceFault& fault : slot->guard.faults())
            json["faults"].push_back(
                {{"device", slot->name},
                 {"reason", control::describe(fault.reason)},
                 {"source", fault.source.front() == 0 ? Json() : Json(std::string(fault.source.data()))},
                 {"time_s", tactus::seconds(fault.tick * slot->period)},
                 {"over_s", fault.over < 0 ? Json() : Json(tactus::seconds(fault.over * slot->period))},
                 {"force_N", fault.force_N}});
    json["faults_not_listed"] = faults_not_kept(engine);
    json["signals"] = Json::array();
    Json all = Json::array();
    for (const auto& stream : engine.host().streams) {
        const StreamFormat& format = stream->format();
        if (format.file.empty() || !stream->loss().empty()) continue;
        all.push_back(format.file);
        if (format.type == &value::signal)
            json["signals"].push_back(
                {{"file", format.file}, {"unit", format.unit}, {"rate_hz", std::lround(rate_of(format.period))}});
    }
    for (const std::string& file : files) all.push_back(file);
    json["files"] = all;
    json["lost"] = losses;
    json["notices"] = engine.host().notices;
    return json.dump(2) + "\n";
}

std::string summary_text(const run::Engine& engine, const Report& report, double seconds,
                         std::optional<double> wall_seconds) {
    std::string text = wall_seconds ? fmt::format("{:.3g} s in {:.3g} s ({:.1f} times real time)", seconds,
                                                  *wall_seconds, seconds / *wall_seconds)
                                    : fmt::format("{:.3g} s live", seconds);
    text += fmt::format(", output {:016x}\n", engine.output_hash());
    for (const auto& group : engine.groups()) {
        const observe::GroupTelemetry& t = group->telemetry;
        text += fmt::format("  {:>8}: {} ticks, {} misses, {} skipped; a call takes {:.1f} µs (p99 {:.1f})\n",
                            group->plan->name, t.ticks.load(), t.misses.load(), t.skipped.load(),
                            t.execution.quantile_ns(0.5) * 1e-3, t.execution.quantile_ns(0.99) * 1e-3);
        if (const std::string late = describe_lateness(*group); !late.empty())
            text += fmt::format("            {}\n", late);
    }
    text += force_text(report);
    if (report.sections.contains("coupling"))
        text += fmt::format("  touching {:.0f} % of the time, at most {:.2f} mm deep; balanced {:.1f} % of the ticks\n",
                            100.0 * number_in(report, "coupling", "in_contact"),
                            number_in(report, "coupling", "penetration_max_mm"),
                            100.0 * number_in(report, "coupling", "balanced"));
    if (report.sections.contains("carve"))
        text += fmt::format("  removed {:.1f} mm³; the bone is {}\n", number_in(report, "carve", "removed_mm3"),
                            number_in(report, "carve", "severed") > 0.0 ? "severed" : "not severed");
    if (const std::vector<double> at = list_of(report, "contact", "blade_mm"); at.size() == 3)
        text += fmt::format(
            "  the blade touched no bone; it ends at {:.1f}, {:.1f}, {:.1f} mm, {:.1f} mm from the surface\n", at[0],
            at[1], at[2], number_in(report, "contact", "blade_clearance_mm"));
    for (const auto& card : engine.host().cards)
        text += fmt::format("  sound on {}: {}\n", card->name(), describe_sound(*card));
    if (const std::int64_t more = faults_not_kept(engine); more > 0)
        text += fmt::format("  {} faults before those that follow\n", more);
    for (const FaultOnRecord& fault : faults_on_record(engine)) text += fmt::format("  fault {}\n", fault.text());
    for (const auto& group : engine.groups())
        if (const std::int64_t lost = group->telemetry.lost_events.load(); lost > 0)
            text += fmt::format("  note: {} events were lost in group {}: more than a wire brings in one tick\n", lost,
                                group->plan->name);
    for (const auto& [section, values] : report.sections)
        if (const auto note = values.find("note"); note != values.end())
            if (const auto* words = std::get_if<std::string>(&note->second))
                text += fmt::format("  note: {}: {}\n", section, *words);
    for (const std::string& notice : engine.host().notices) text += fmt::format("  note: {}\n", notice);
    return text;
}

TaskSummary read_task_summary(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "summary.json";
    if (!std::filesystem::exists(file)) {
        const bool was_cut_off =
            std::filesystem::exists(folder / "task.csv.part") || std::filesystem::exists(folder / "summary.json.part");
        throw Error(was_cut_off
                        ? fmt::format("{}: the run did not come to its end; score its take instead, or finish it with "
                                      "'tactus replay TAKE --out FOLDER'",
                                      folder.string())
                        : fmt::format("{}: is neither the results of a run nor a take nor a session", folder.string()));
    }
    const Json json = Json::parse_or_null(file::read_whole_file(file));
    if (!json.is_object()) throw Error(fmt::format("{}: not JSON", file.string()));
    const auto task = json.find("task");
    if (!task || !task->is_object())
        throw Error(fmt::format("{}: the run had no node 'task', so there is nothing to score", file.string()));
    const auto text = [&](const char* key) {
        const auto found = task->find(key);
        if (!found || !found->is_string())
            throw Error(fmt::format("{}: does not state the task's '{}'", file.string(), key));
        return found->get<std::string>();
    };
    TaskSummary summary;
    summary.file = text("file");
    summary.hash = text("hash");
    summary.record = text("record");
    if (const auto force = task->find("force"); force != task->end() && force->is_string())
        summary.has_force = force->get<std::string>() == "recorded";
    if (const auto sources = json.find("carve_sources"); sources != json.end() && sources->is_object())
        for (const auto& [node, hash] : sources->items())
            if (hash.is_string()) summary.bones.push_back(hash.get<std::string>());
    if (const auto carve = json.find("carve"); carve != json.end() && carve->is_object())
        if (const auto refined = carve->find("refined"); refined != carve->end() && refined->is_number())
            summary.refined = refined->get<double>() > 0.0;
    const auto number = [&](const char* section, const char* key, double otherwise) {
        const auto part = json.find(section);
        if (!part || !part->is_object()) return otherwise;
        const auto value = part->find(key);
        return value && value->is_number() && value->get<double>() > 0.0 ? value->get<double>() : otherwise;
    };
    summary.device_scale = number("force", "device_scale", 1.0);
    summary.limited = number("contact", "limited_fraction", 0.0);
    return summary;
}

}  // namespace tactus::run

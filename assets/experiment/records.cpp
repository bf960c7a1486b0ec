// SPDX-License-Identifier: Apache-2.0
#include "assets/experiment/records.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

namespace tactus::experiment {

namespace fs = std::filesystem;
using file::Json;

namespace {

constexpr std::array<const char*, 4> phases{"practice", "main", "catch", "repeat"};

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::optional<double> optional_of(const Json& json, const char* key) {
    const Json* found = json.find(key);
    return found && found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

/// The name of a folder within the subject's, and nothing that leads elsewhere.
std::string folder_of(const Json& json) {
    const std::string name = json["folder"].get<std::string>();
    if (fs::path(name).has_parent_path() || name.empty() || name == "." || name == "..")
        throw Error(fmt::format("'{}' is no folder of a trial", name));
    return name;
}

Json json_of(const TrialRecord& t) {
    Json json{
        {"number", t.number}, {"block", t.block},     {"phase", name_of(t.phase)}, {"condition", t.condition},
        {"task", t.task},     {"seconds", t.seconds}, {"folder", t.folder},        {"output_hash", t.output_hash}};
    if (t.task.empty()) {
        json.update({{"level", t.level},
                     {"interval", t.interval},
                     {"rendered", t.rendered},
                     {"rendered_level", optional_json(t.rendered_level)},
                     {"answer", t.answer},
                     {"correct", t.is_correct},
                     {"response_time_s", optional_json(t.response_time)}});
        if (t.match || !t.turns.empty()) {
            json["match"] = optional_json(t.match);
            json["turns"] = Json::array();
            for (const Turn& turn : t.turns) json["turns"].push_back(Json::array({turn.time, turn.level}));
        }
    } else {
        json["measures"] = t.measures;
        json["finished"] = t.is_finished;
    }
    json.update({{"missed", t.missed},
                 {"gap_s", t.gap},
                 {"limited", t.limited},
                 {"sound_limited", t.sound_limited},
                 {"marked", t.marked},
                 {"simulated", t.is_simulated},
                 {"rehearsal", t.is_rehearsal}});
    return json;
}

TrialRecord trial_of(const Json& json) {
    TrialRecord t;
    t.number = json["number"].get<int>();
    t.block = json["block"].get<int>();
    const std::string phase = json["phase"].get<std::string>();
    std::size_t index = 0;
    while (index < phases.size() && phase != phases[index]) ++index;
    if (index == phases.size()) throw Error(fmt::format("'{}' is no phase", phase));
    t.phase = static_cast<Phase>(index);
    t.condition = json["condition"].get<std::string>();
    t.task = json["task"].get<std::string>();
    t.seconds = json["seconds"].get<double>();
    t.folder = folder_of(json);
    t.output_hash = json["output_hash"].get<std::string>();
    if (t.task.empty()) {
        t.level = json["level"].get<double>();
        t.interval = json["interval"].get<int>();
        // An interval without anything to measure was written as null.
        for (const Json& one : json["rendered"])
            t.rendered.push_back(one.is_number() ? one.get<double>() : std::numeric_limits<double>::quiet_NaN());
        t.rendered_level = optional_of(json, "rendered_level");
        t.answer = json["answer"].get<int>();
        t.is_correct = json["correct"].get<bool>();
        t.response_time = optional_of(json, "response_time_s");
        t.match = optional_of(json, "match");
        if (const Json* turns = json.find("turns"))
            for (const Json& turn : *turns) t.turns.push_back({turn[0].get<double>(), turn[1].get<double>()});
    } else {
        // A measure that is not a number was written as null.
        for (const auto& [name, value] : json["measures"].items())
            if (value.is_number()) t.measures[name] = value.get<double>();
        t.is_finished = json["finished"].get<bool>();
    }
    t.missed = json["missed"].get<double>();
    t.gap = json["gap_s"].get<double>();
    t.limited = json["limited"].get<double>();
    t.sound_limited = json.value("sound_limited", 0.0);  // trials of before it was noted have none
    t.marked = json["marked"].get<std::string>();
    t.is_simulated = json["simulated"].get<bool>();
    t.is_rehearsal = json["rehearsal"].get<bool>();
    return t;
}

}  // namespace

const char* name_of(Phase phase) { return phases[static_cast<std::size_t>(phase)]; }

ExperimentFile load_experiment_file(const fs::path& path) {
    try {
        const Json json = Json::parse(file::read_whole_file(path));
        if (json["format"] != Json(data_format)) throw Error(fmt::format("format {} is expected", data_format));
        ExperimentFile experiment;
        experiment.name = json["name"].get<std::string>();
        experiment.protocol = json["protocol"].get<std::string>();
        for (const Json& one : json["files"]) {
            experiment.files.push_back({one["name"].get<std::string>(), one["hash"].get<std::string>()});
            const fs::path name = experiment.files.back().name;
            if (name.is_absolute() || std::ranges::find(name, "..") != name.end())
                throw Error(fmt::format("the file '{}' is outside of the folder", name.string()));
        }
        // Folders of before assets were hashed have none.
        if (json.contains("assets"))
            for (const Json& one : json["assets"])
                experiment.assets.push_back({one["name"].get<std::string>(), one["hash"].get<std::string>()});
        for (const Json& one : json["subjects"]) {
            // A folder is named by it.
            const std::string who = one["pseudonym"].get<std::string>();
            if (who.empty() ||
                !std::ranges::all_of(who, [](unsigned char c) { return c < 128 && std::isalnum(c) != 0; }))
                throw Error(fmt::format("'{}' is no pseudonym of letters and digits", who));
            experiment.subjects.push_back({one["pseudonym"].get<std::string>(),
                                           one["row"].get<std::size_t>(),
                                           one["simulated"].get<bool>(),
                                           one["consent"].get<std::string>(),
                                           one["complete"].get<bool>(),
                                           one["registration"].get<std::string>(),
                                           {}});
            // Folders of before settings were stored do not say what they were.
            if (const Json* settings = one.find("settings")) {
                auto& known = experiment.subjects.back().settings.emplace();
                for (const Json& setting : *settings) known.push_back(setting.get<std::string>());
            }
        }
        for (const Json& one : json["freed_rows"]) experiment.freed_rows.push_back(one.get<std::size_t>());
        return experiment;
    } catch (const Error& error) {
        throw Error(fmt::format("{}: is damaged, or no experiment: {}", path.string(), error.message()));
    }
}

void save_experiment_file(const ExperimentFile& experiment, const fs::path& path) {
    Json json{{"format", data_format},
              {"name", experiment.name},
              {"protocol", experiment.protocol},
              {"files", Json::array()},
              {"assets", Json::array()},
              {"subjects", Json::array()},
              {"freed_rows", experiment.freed_rows}};
    for (const FrozenFile& one : experiment.assets) json["assets"].push_back({{"name", one.name}, {"hash", one.hash}});
    for (const FrozenFile& one : experiment.files) json["files"].push_back({{"name", one.name}, {"hash", one.hash}});
    for (const SubjectEntry& one : experiment.subjects) {
        Json subject{{"pseudonym", one.pseudonym},    {"row", one.row},
                     {"simulated", one.is_simulated}, {"consent", one.consent},
                     {"complete", one.is_complete},   {"registration", one.registration}};
        if (one.settings) subject["settings"] = *one.settings;
        json["subjects"].push_back(std::move(subject));
    }
    file::write_durable_file(path, json.dump(2) + "\n");
}

std::vector<TrialRecord> load_trials(const fs::path& path) {
    std::vector<TrialRecord> trials;
    if (!fs::exists(path)) return trials;
    const std::string text = file::read_whole_file(path);
    int number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        ++number;
        try {
            trials.push_back(trial_of(Json::parse(std::string_view(text).substr(begin, end - begin))));
        } catch (const Error& error) {
            throw Error(SourceLocation{path.string(), number, 1}, fmt::format("is damaged: {}", error.message()));
        }
        begin = end + 1;
    }
    return trials;
}

void save_trials(const std::vector<TrialRecord>& trials, const fs::path& path) {
    std::string text;
    for (const TrialRecord& trial : trials) text += json_of(trial).dump() + "\n";
    file::write_durable_file(path, text);
}

}  // namespace tactus::experiment

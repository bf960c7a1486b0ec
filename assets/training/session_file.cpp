// SPDX-License-Identifier: Apache-2.0
#include "assets/training/session_file.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <charconv>

namespace tactus::training {

namespace fs = std::filesystem;
using file::Json;

namespace {

std::string text_in(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found && found->is_string() ? found->get<std::string>() : std::string();
}

SessionTask read_task(const Json& json, const std::string& file) {
    if (!json.is_object()) throw Error(fmt::format("{}: is damaged: a task is no object", file));
    SessionTask task{text_in(json, "name"), text_in(json, "file"), 0};
    const std::string hash = text_in(json, "hash");
    const auto [end, failure] = std::from_chars(hash.data(), hash.data() + hash.size(), task.hash, 16);
    if (failure != std::errc{} || end != hash.data() + hash.size())
        throw Error(fmt::format("{}: is damaged: '{}' is no hash", file, hash));
    return task;
}

SessionAttempt read_attempt(const Json& json, const std::string& file) {
    if (!json.is_object()) throw Error(fmt::format("{}: is damaged: an attempt is no object", file));
    SessionAttempt attempt{text_in(json, "folder"), text_in(json, "time"), 0.0, false};
    // A name that leads nowhere else.
    const std::string& name = attempt.folder;
    if (name.empty() || fs::path(name).has_parent_path() || name == "." || name == "..")
        throw Error(fmt::format("{}: is damaged: '{}' is no folder of an attempt", file, name));
    if (const auto seconds = json.find("seconds"); seconds && seconds->is_number())
        attempt.seconds = seconds->get<double>();
    if (const auto early = json.find("ended_early"); early && early->is_boolean())
        attempt.ended_early = early->get<bool>();
    return attempt;
}

}  // namespace

SessionFile load_session_file(const fs::path& path) {
    const std::string file = path.string();
    const Json json = Json::parse_or_null(file::read_whole_file(path));
    if (!json.is_object() || !json.contains("format") || !json.contains("tasks") || !json.contains("attempts") ||
        !json["tasks"].is_array() || !json["attempts"].is_array())
        throw Error(fmt::format("{}: is damaged, or no session", file));
    if (json["format"] != session_format)
        throw Error(fmt::format("{}: has format {}, but this program reads format {}", file, json["format"].dump(),
                                session_format));
    SessionFile session{text_in(json, "trainee"), {}, {}};
    for (const Json& task : json["tasks"]) session.tasks.push_back(read_task(task, file));
    for (const Json& attempt : json["attempts"]) session.attempts.push_back(read_attempt(attempt, file));
    if (session.attempts.size() > session.tasks.size())
        throw Error(fmt::format("{}: is damaged: more attempts than tasks", file));
    return session;
}

void save_session_file(const SessionFile& session, const fs::path& path) {
    Json json{{"format", session_format},  {"trainee", session.trainee},
              {"scores", "not validated"}, {"tasks", Json::array()},
              {"attempts", Json::array()}, {"complete", session.attempts.size() == session.tasks.size()}};
    for (const SessionTask& task : session.tasks)
        json["tasks"].push_back(
            {{"name", task.name}, {"file", task.file.string()}, {"hash", fmt::format("{:016x}", task.hash)}});
    for (const SessionAttempt& attempt : session.attempts)
        json["attempts"].push_back({{"folder", attempt.folder},
                                    {"time", attempt.time},
                                    {"seconds", attempt.seconds},
                                    {"ended_early", attempt.ended_early}});
    file::write_durable_file(path, json.dump(2) + "\n");
}

}  // namespace tactus::training

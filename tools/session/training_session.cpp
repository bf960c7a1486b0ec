// SPDX-License-Identifier: Apache-2.0
#include "tools/session/training_session.hpp"

#include "assets/cases/plan_file.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace tactus::session {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr int session_format = 1;
constexpr const char* file_name = "session.json";

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

Json session_json(const fs::path& folder) {
    const fs::path file = folder / file_name;
    Json json = Json::parse(file::read_whole_file(file), nullptr, false);
    if (!json.is_object() || !json.contains("format") || !json.contains("tasks") || !json.contains("attempts") ||
        !json["tasks"].is_array() || !json["attempts"].is_array())
        throw Error(fmt::format("{}: is damaged, or no session", file.string()));
    if (json["format"] != session_format)
        throw Error(fmt::format("{}: has format {}, but this program reads format {}", file.string(),
                                json["format"].dump(), session_format));
    return json;
}

/// The folder name of an attempt: one that leads nowhere else.
std::string attempt_folder(const Json& attempt, const fs::path& session) {
    if (!attempt.is_object() || !attempt.contains("folder") || !attempt["folder"].is_string())
        throw Error(fmt::format("{}: is damaged: an attempt without a folder", (session / file_name).string()));
    const std::string name = attempt["folder"].get<std::string>();
    if (name.empty() || fs::path(name).has_parent_path() || name == "." || name == "..")
        throw Error(
            fmt::format("{}: is damaged: '{}' is no folder of an attempt", (session / file_name).string(), name));
    return name;
}

/// Number of the trainee's last session, 0: none.
int last_session(const fs::path& folder) {
    int last = 0;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        int number = 0;
        const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), number);
        if (failure == std::errc{} && end == name.data() + name.size() && entry.is_directory(ignored))
            last = std::max(last, number);
    }
    return last;
}

}  // namespace

void check_pseudonym(const std::string& name) {
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) && static_cast<unsigned char>(c) < 128;
    };
    const bool good =
        !name.empty() && name.size() <= 64 && is_plain(name.front()) && name.back() != '.' &&
        std::ranges::all_of(name, [&](char c) { return is_plain(c) || c == '-' || c == '_' || c == '.'; });
    if (!good)
        throw Error(
            "--trainee must be a pseudonym that can be a file name: 1 to 64 letters a to z, digits, '-', '_' or "
            "'.', beginning with a letter or digit");
}

TrainingSession::TrainingSession(const Choice& choice) : trainee_(choice.trainee), tasks_(choice.tasks) {
    check_pseudonym(trainee_);
    const fs::path home = choice.out / trainee_;
    std::error_code failure;
    fs::create_directories(home, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", home.string(), failure.message()));
    const int last = last_session(home);
    if (last > 0 && !choice.is_new) {
        folder_ = home / std::to_string(last);
        lock();
        // A session that was killed before its first line has nothing to resume but its number.
        if (!fs::exists(folder_ / file_name)) {
            save();
            return;
        }
        read();
        if (!is_complete()) {
            is_resumed_ = true;
            put_aside();
            return;
        }
        lock_ = Lock{};
        tasks_ = choice.tasks;
        done_.clear();
    }
    folder_ = home / std::to_string(last + 1);
    lock();
    save();
}

TrainingSession::Lock& TrainingSession::Lock::operator=(Lock&& other) noexcept {
    std::swap(handle, other.handle);
    return *this;
}

TrainingSession::Lock::~Lock() {
    if (handle >= 0) ::close(handle);
}

void TrainingSession::lock() {
    std::error_code failure;
    fs::create_directories(folder_, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder_.string(), failure.message()));
    lock_ = Lock{::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    if (lock_.handle < 0) throw Error(fmt::format("{}: cannot be used: {}", folder_.string(), std::strerror(errno)));
    if (::flock(lock_.handle, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw Error(fmt::format("{}: another program runs this session", folder_.string()));
}

void TrainingSession::read() {
    const Json json = session_json(folder_);
    std::vector<std::string> names, hashes;
    for (const Json& task : json["tasks"]) {
        names.push_back(task.value("name", ""));
        hashes.push_back(task.value("hash", ""));
    }
    for (const Json& attempt : json["attempts"])
        done_.push_back({attempt_folder(attempt, folder_), attempt.value("time", ""), attempt.value("seconds", 0.0),
                         attempt.value("ended_early", false)});
    if (done_.size() > names.size())
        throw Error(fmt::format("{}: is damaged: more attempts than tasks", (folder_ / file_name).string()));
    if (done_.size() == names.size()) {
        tasks_.resize(names.size());  // complete: which tasks it had does not matter any more
        return;
    }
    bool same = names.size() == tasks_.size();
    for (std::size_t n = 0; same && n < names.size(); ++n)
        same = names[n] == tasks_[n].name && hashes[n] == hex(tasks_[n].hash);
    if (same) return;
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : " ") + name;
    throw Error(
        fmt::format("{}: this session is not complete and has other tasks ({}), or one of them has changed; "
                    "give the same tasks to resume it, or --new to begin another",
                    folder_.string(), list));
}

void TrainingSession::save() const {
    Json json{{"format", session_format}, {"trainee", trainee_},       {"scores", "not validated"},
              {"tasks", Json::array()},   {"attempts", Json::array()}, {"complete", is_complete()}};
    for (const SessionTask& task : tasks_)
        json["tasks"].push_back({{"name", task.name}, {"file", task.file.string()}, {"hash", hex(task.hash)}});
    for (const Done& done : done_)
        json["attempts"].push_back({{"folder", done.folder},
                                    {"time", done.time},
                                    {"seconds", done.seconds},
                                    {"ended_early", done.ended_early}});
    file::write_durable_file(folder_ / file_name, json.dump(2) + "\n");
}

std::string TrainingSession::attempt_name(std::size_t n) const {
    return fmt::format("{:02}-{}", n + 1, tasks_[n].name);
}

/// An attempt of which the session does not say that it was completed keeps its take under another name.
void TrainingSession::put_aside() const {
    const fs::path left = folder_ / attempt_name(done());
    if (!fs::exists(left)) return;
    for (int n = 1; n < 10'000; ++n) {
        const fs::path other = fmt::format("{}-cut-off-{}", left.string(), n);
        if (fs::exists(other)) continue;
        std::error_code failure;
        fs::rename(left, other, failure);
        if (failure)
            throw Error(
                fmt::format("{}: cannot be renamed to {}: {}", left.string(), other.string(), failure.message()));
        return;
    }
    throw Error(fmt::format("{}: too many attempts were cut off", left.string()));
}

fs::path TrainingSession::begin_attempt() const {
    const fs::path folder = folder_ / attempt_name(done());
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder.string(), failure.message()));
    return folder;
}

void TrainingSession::complete_attempt(double seconds, bool ended_early) {
    done_.push_back({attempt_name(done()), cases::time_of_day(), seconds, ended_early});
    save();
}

bool is_training_session(const fs::path& folder) { return fs::is_regular_file(folder / file_name); }

std::vector<fs::path> completed_attempts(const fs::path& session) {
    std::vector<fs::path> all;
    const Json json = session_json(session);
    for (const Json& attempt : json["attempts"]) all.push_back(session / attempt_folder(attempt, session));
    return all;
}

std::string trainee_of_attempt(const fs::path& attempt) {
    const fs::path session = fs::absolute(attempt).lexically_normal();
    const fs::path folder = session.has_filename() ? session.parent_path() : session.parent_path().parent_path();
    if (!is_training_session(folder)) return {};
    const Json json = session_json(folder);
    return json.value("trainee", "");
}

}  // namespace tactus::session

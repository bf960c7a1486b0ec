// SPDX-License-Identifier: Apache-2.0
#include "tools/run/training_session.hpp"

#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

namespace tactus::run {

namespace fs = std::filesystem;
namespace {

constexpr const char* file_name = "session.json";

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

TrainingSession::TrainingSession(const Choice& choice) : file_{choice.trainee, choice.tasks, {}} {
    check_pseudonym(choice.trainee);
    const fs::path home = choice.out / choice.trainee;
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
        file_ = training::load_session_file(folder_ / file_name);
        if (!is_complete()) {
            check_tasks(choice.tasks);
            is_resumed_ = true;
            put_aside();
            return;
        }
        lock_ = Lock{};
        file_ = {choice.trainee, choice.tasks, {}};
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

void TrainingSession::check_tasks(const std::vector<training::SessionTask>& wanted) const {
    if (std::ranges::equal(file_.tasks, wanted, [](const training::SessionTask& a, const training::SessionTask& b) {
            return a.name == b.name && a.hash == b.hash;
        }))
        return;
    std::string list;
    for (const training::SessionTask& task : file_.tasks) list += (list.empty() ? "" : " ") + task.name;
    throw Error(
        fmt::format("{}: this session is not complete and has other tasks ({}), or one of them has changed; "
                    "give the same tasks to resume it, or --new to begin another",
                    folder_.string(), list));
}

void TrainingSession::save() const { training::save_session_file(file_, folder_ / file_name); }

/// The name comes from session.json, which is not trusted with a path.
std::string TrainingSession::attempt_name() const {
    return fmt::format("{:02}-{}", done() + 1, fs::path(file_.tasks[done()].name).filename().string());
}

/// An attempt of which the session does not say that it was completed keeps its take under another name.
void TrainingSession::put_aside() const {
    const fs::path left = next_attempt();
    if (!fs::exists(left)) return;
    const auto files = fs::recursive_directory_iterator(left);
    if (std::none_of(begin(files), end(files), [](const auto& entry) { return !entry.is_directory(); })) {
        fs::remove_all(left);
        return;
    }
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

void TrainingSession::complete_attempt(double seconds, bool ended_early) {
    file_.attempts.push_back({attempt_name(), plan::time_of_day(), seconds, ended_early});
    save();
}

bool is_training_session(const fs::path& folder) { return fs::is_regular_file(folder / file_name); }

std::vector<fs::path> completed_attempts(const fs::path& session) {
    std::vector<fs::path> all;
    for (const training::SessionAttempt& attempt : training::load_session_file(session / file_name).attempts)
        all.push_back(session / attempt.folder);
    return all;
}

std::string trainee_of_attempt(const fs::path& attempt) {
    const fs::path session = fs::absolute(attempt).lexically_normal();
    const fs::path folder = session.has_filename() ? session.parent_path() : session.parent_path().parent_path();
    return is_training_session(folder) ? training::load_session_file(folder / file_name).trainee : std::string();
}

}  // namespace tactus::run

// SPDX-License-Identifier: Apache-2.0
// session.json: the tasks of a training session and the completed attempts. docs/reference/task-file.md describes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::training {

inline constexpr int session_format = 1;

struct SessionTask {
    std::string name;            ///< stem of the task file
    std::filesystem::path file;  ///< absolute
    std::uint64_t hash = 0;      ///< of the task
};

struct SessionAttempt {
    std::string folder;  ///< within the session
    std::string time;    ///< of its end
    double seconds = 0.0;
    bool ended_early = false;
};

struct SessionFile {
    std::string trainee;  ///< a pseudonym
    std::vector<SessionTask> tasks;
    std::vector<SessionAttempt> attempts;  ///< completed, in the order of the tasks
};

/// Throws Error if the file is damaged, has another format, or names a folder outside of the session.
SessionFile load_session_file(const std::filesystem::path& path);

/// Replaces the file as a whole, synced to disk. Throws Error.
void save_session_file(const SessionFile& session, const std::filesystem::path& path);

}  // namespace tactus::training

// SPDX-License-Identifier: Apache-2.0
// The folder of a training session: tasks in order with one attempt each; it is saved and can be resumed.
//
//   DIR/PSEUDONYM/1/session.json          trainee, tasks, attempts; replaced as a whole after each attempt
//   DIR/PSEUDONYM/1/01-NAME/run, /take    results and take of the attempt at the first task
//   DIR/PSEUDONYM/1/01-NAME-cut-off-1     files of an interrupted attempt
#pragma once

#include "assets/training/session_file.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::run {

/// Throws Error unless `name` is 1 to 64 letters, digits, '-', '_' or '.', beginning with a letter or digit. The
/// restriction is needed because it becomes the name of a folder.
void check_pseudonym(const std::string& name);

class TrainingSession {
public:
    struct Choice {
        std::string trainee;
        std::filesystem::path out;
        std::vector<training::SessionTask> tasks;
        bool is_new = false;  ///< start a new session although the last one is not complete
    };
    /// Opens the trainee's last session if it is not complete, otherwise starts the next one; locks it until destroyed.
    /// Moves interrupted attempts aside, and removes those without a file, which never began. Throws Error if the session to resume has other tasks, if another program has
    /// locked it, or if the folder cannot be written.
    explicit TrainingSession(const Choice& choice);
    TrainingSession(const TrainingSession&) = delete;
    TrainingSession& operator=(const TrainingSession&) = delete;

    const std::filesystem::path& folder() const { return folder_; }
    bool is_resumed() const { return is_resumed_; }
    /// Number of completed attempts, which is the index of the next task.
    std::size_t done() const { return file_.attempts.size(); }
    bool is_complete() const { return done() == count(); }
    std::size_t count() const { return file_.tasks.size(); }
    /// Folder of the next attempt. The run makes it: an attempt that cannot be started leaves none, which would be taken
    /// for an interrupted one.
    std::filesystem::path next_attempt() const { return folder_ / attempt_name(); }
    /// Marks the next attempt as completed, so that it is never repeated. Throws Error.
    void complete_attempt(double seconds, bool ended_early);

private:
    /// Lock of the session's folder; the system releases it when the process ends.
    struct Lock {
        int handle = -1;
        explicit Lock(int opened = -1) : handle(opened) {}
        Lock& operator=(Lock&& other) noexcept;
        ~Lock();
    };
    void lock();
    void check_tasks(const std::vector<training::SessionTask>& wanted) const;
    void save() const;
    void put_aside() const;
    std::string attempt_name() const;

    std::filesystem::path folder_;
    training::SessionFile file_;
    bool is_resumed_ = false;
    Lock lock_;
};

bool is_training_session(const std::filesystem::path& folder);

/// Folders of the completed attempts of a session, in order. Throws Error when session.json is damaged.
std::vector<std::filesystem::path> completed_attempts(const std::filesystem::path& session);

/// Returns the trainee of the session that contains an attempt's folder; empty if there is none.
std::string trainee_of_attempt(const std::filesystem::path& attempt);

}  // namespace tactus::run

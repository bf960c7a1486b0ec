// SPDX-License-Identifier: Apache-2.0
// What the summary of a run says of its task.
#pragma once

#include <filesystem>
#include <string>

namespace tactus::session {

struct TaskSummary {
    std::string file, hash;  ///< of the task
    std::string record;      ///< name of the table of the attempt, beside the summary
};

/// Reads FOLDER/summary.json. Throws Error when there is none, when the run did not come to its end, or when it had no
/// node 'task'.
TaskSummary read_task_summary(const std::filesystem::path& folder);

}  // namespace tactus::session

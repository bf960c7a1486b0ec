// SPDX-License-Identifier: Apache-2.0
// What the summary of a run says of its task.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::session {

struct TaskSummary {
    std::string file, hash;  ///< of the task
    std::string record;      ///< name of the table of the attempt, beside the summary
    std::vector<std::string> bones;  ///< bone::content_hash of each bone that was cut; empty: the run does not say
    bool has_force = true;  ///< the record holds the force on the hand
    bool refined = false;  ///< a bone was resampled around the site
    double device_scale = 1.0;  ///< forces on the device over those of the tool
    double limited = 0.0;  ///< fraction of the time in contact in which the device gave less than the tool wanted
};

/// Reads FOLDER/summary.json. Throws Error when there is none, when the run did not come to its end, or when it had no
/// node 'task'.
TaskSummary read_task_summary(const std::filesystem::path& folder);

}  // namespace tactus::session

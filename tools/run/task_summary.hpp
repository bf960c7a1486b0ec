// SPDX-License-Identifier: Apache-2.0
// The part of a run's summary about its task.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::run {

struct TaskSummary {
    std::string file, hash;  ///< of the task
    std::string record;      ///< name of the table of the attempt, beside the summary
    std::vector<std::string> bones;  ///< bone::content_hash of each bone that was cut; empty: unknown
    bool has_force = true;  ///< the record contains the force on the hand
    bool refined = false;  ///< a bone was resampled around the site
    double device_scale = 1.0;  ///< forces on the device divided by those of the tool
    double limited = 0.0;  ///< fraction of the contact time in which the device gave less than the commanded force
};

/// Reads FOLDER/summary.json. Throws Error if there is none, if the run did not end normally, or if it had no node
/// 'task'.
TaskSummary read_task_summary(const std::filesystem::path& folder);

}  // namespace tactus::run

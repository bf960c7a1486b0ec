// SPDX-License-Identifier: Apache-2.0
// What is ended by force: commands that write, in a folder that holds earlier work.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::campaign {

struct Job {
    std::string name;
    std::string script;  ///< for sh, in the folder; $T is the command, $N tells two at once apart: "" and "-2"
    std::vector<std::string> may_change = {};  ///< earlier files that it writes over
    bool ends_in_order = false;  ///< TERM and HUP end it in order
    double seconds = 0.0;  ///< what it takes undisturbed
};

/// Makes earlier work in `folder`: a patch, results, a take, a bone, a CT, a plan with its fragments, a window's script.
void make_earlier_work(const std::filesystem::path& folder);

/// Run, render, import, plan; with a display, view.
std::vector<Job> crash_jobs(bool has_display);

}  // namespace tactus::campaign

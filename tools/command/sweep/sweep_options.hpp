// SPDX-License-Identifier: Apache-2.0
// Helpers shared by the 'sweep' verbs.
#pragma once

#include "tools/analysis/sweep/local_runner.hpp"

#include <string>

namespace tactus::command {

/// Runs a verb within this process: what a resident worker does.
int run_verb_here(const std::vector<std::string>& words);

/// Settings of a local run: version, program, and resident verbs.
analysis::LocalRun local_run(int jobs, const std::string& runner);

/// "312 of 1000 points, 2 failed; 3 to 4 min left".
std::string progress_text(const analysis::RunProgress& progress);

}  // namespace tactus::command

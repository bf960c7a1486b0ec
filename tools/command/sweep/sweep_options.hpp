// SPDX-License-Identifier: Apache-2.0
// Helpers shared by the 'sweep' verbs.
#pragma once

#include "tools/analysis/sweep/local_runner.hpp"
#include "tools/analysis/sweep/results.hpp"

#include <string>

namespace tactus::command {

/// Runs a verb within this process: what a resident worker does.
int run_verb_here(const std::vector<std::string>& words);

/// Settings of a local run: version, program, and resident verbs.
analysis::LocalRun local_run(int jobs, const std::string& runner);

/// "312 of 1000 points, 2 failed; 3 to 4 min left".
std::string progress_text(const analysis::RunProgress& progress);

/// "3 s", "2.5 min", "4.1 h", "3.2 days".
std::string duration_text(double seconds);

/// Counts, and failures with their reasons first.
std::string results_text(const analysis::Results& results);

/// The words of a step (from 1) at a point, as a shell would read them; for repeating it by hand.
std::string point_text(const analysis::SweepFolder& folder, std::size_t index, int step = 1);

}  // namespace tactus::command

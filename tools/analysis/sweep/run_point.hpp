// SPDX-License-Identifier: Apache-2.0
// One point of a sweep: its steps, the values and files that are kept, and their hash.
#pragma once

#include "assets/file/json.hpp"
#include "assets/sweep/row_log.hpp"
#include "tools/analysis/sweep/sweep_folder.hpp"
#include "tools/run/child_process.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::analysis {

/// Runs a verb of Tactus within this process; the words are those after "tactus". Returns the exit code.
using RunVerb = std::function<int(const std::vector<std::string>& words)>;

struct PointContext {
    const SweepFolder* folder = nullptr;
    std::filesystem::path scratch;  ///< empty folder for the point; removed afterwards
    std::filesystem::path program;  ///< this program, for {tactus} and where `run_verb` is null
    RunVerb run_verb;               ///< null: each verb runs in a process of its own
    bool keeps_files = true;        ///< false: kept files are hashed and dropped
    run::ProcessLimits limits;      ///< of each process; a worker has none: its parent watches it
};

/// Runs the steps of a point in order, with standard output and error captured. A step that fails ends it. Fills all of
/// the row but the attempt. Never throws for a failure of the point.
sweep::Row run_point(const PointContext& context, std::size_t index);

/// The value at a JSON pointer (RFC 6901); null: none.
const file::Json* value_at(const file::Json& json, std::string_view pointer);

}  // namespace tactus::analysis

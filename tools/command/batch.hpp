// SPDX-License-Identifier: Apache-2.0
// Runs a job for each of many items in parallel, with a progress bar; failures do not stop the others.
#pragma once

#include "assets/table/csv_field.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::command {

/// Processes one item; may call `progress` with the fraction done.
using BatchJob = std::function<void(std::size_t index, const std::function<void(double share)>& progress)>;

/// Runs job(0) … job(count − 1), `jobs` at a time (0: one per core). Returns the error of each item, empty for success.
/// `is_quiet`: without progress.
std::vector<std::string> run_batch(std::size_t count, int jobs, std::string_view what, const BatchJob& job,
                                   bool is_quiet = false);

/// Prints the errors on standard error. Returns their number.
std::size_t tell_failures(const std::vector<std::string>& failures);

/// Throws Error if an output that is a file for one input, and a folder for several, has the name of the other kind. A
/// name with one of `endings` is that of a file. Devices, pipes and existing folders may have any name.
void check_batch_output(const std::filesystem::path& out, const std::vector<std::string>& endings, bool has_several);

using table::csv_field;

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
// The same for each of many: some at a time, with a bar that tells how far it is, and on past those that fail.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::command {

/// Does one of them; may call `progress` with the share of it that is done.
using BatchJob = std::function<void(std::size_t index, const std::function<void(double share)>& progress)>;

/// Runs job(0) … job(count − 1), `jobs` at a time (0: one per core). Returns what each threw, empty where it went well.
std::vector<std::string> run_batch(std::size_t count, int jobs, std::string_view what, const BatchJob& job);

/// Prints what went wrong on standard error. Returns how many there are.
std::size_t tell_failures(const std::vector<std::string>& failures);

/// "[####    ] 3 of 8 files"
std::string progress_bar(std::size_t finished, std::size_t count, std::string_view what);

/// A field of a CSV file, in quotes where it needs them.
std::string csv_field(const std::string& text);

}  // namespace tactus::command

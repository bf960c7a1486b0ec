// SPDX-License-Identifier: Apache-2.0
// Plan files: JSON, with numbers that read back to the same bits.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::plan {

inline constexpr int plan_file_version = 1;

/// The text of a plan file. Lengths in m, quaternions w x y z; numbers have as many digits as an exact round trip
/// needs.
std::string plan_text(const CasePlan& plan);

/// Parses a plan; `file` is its name in messages. Throws Error with the position for text that is not a plan, is
/// truncated, has another version, duplicate fragment names, steps without predecessor or that cannot be applied, or
/// invalid poses.
CasePlan read_plan_text(std::string_view text, const std::string& file);

/// Reads a plan file. Throws Error as above. After a crash during a save, the file holds the last complete plan.
CasePlan load_case_plan(const std::filesystem::path& path);

/// Writes a temporary file, syncs it to disk and renames it: after a crash the file is the old or the new plan. Throws
/// Error.
void save_case_plan(const CasePlan& plan, const std::filesystem::path& path);

/// The current time as "2026-01-31T12:34:56.789Z".
std::string time_of_day();

}  // namespace tactus::plan

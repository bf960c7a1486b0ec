// SPDX-License-Identifier: Apache-2.0
// Plans on disk: JSON, numbers so that reading gives the same bits.
#pragma once

#include "assets/cases/case_plan.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace tactus::cases {

inline constexpr int plan_file_version = 1;

/// The text of a plan file. Lengths are m, quaternions w x y z; every number is written with as many digits as its bits
/// need.
std::string plan_text(const CasePlan& plan);

/// A plan from its text; `file` is its name in messages. Throws Error, saying where, for text that is no plan, that
/// ends in
/// the middle, of another version, with two fragments of one name, steps that follow none or cannot be applied, and
/// poses that are none.
CasePlan read_plan_text(std::string_view text, const std::string& file);

/// Reads a plan file. Throws Error as above. A plan that was being written when the machine failed is the last whole
/// one.
CasePlan load_case_plan(const std::filesystem::path& path);

/// Writes beside, makes sure of the disk, and renames: after a crash the file is the old plan or the new one. Throws
/// Error.
void save_case_plan(const CasePlan& plan, const std::filesystem::path& path);

/// Now, as "2026-01-31T12:34:56.789Z".
std::string time_of_day();

}  // namespace tactus::cases

// SPDX-License-Identifier: Apache-2.0
// The paths in a plan. A plan in memory has absolute ones, so that it can be saved in any folder.
#pragma once

#include "assets/plan/case_plan.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace tactus::plan {

/// Paths as written in a plan file, by the absolute paths that replace them.
using WrittenPaths = std::map<std::string, std::string>;

/// Makes all paths of fragments, mirror targets, painted bones and reconstructions absolute. `folder`: of the plan file.
WrittenPaths make_files_absolute(CasePlan& plan, const std::filesystem::path& folder);

/// For a plan file in `folder`: paths are as `written`, others below the folder become relative to it. So a case whose
/// folder is moved keeps its files.
void make_files_relative(CasePlan& plan, const std::filesystem::path& folder, const WrittenPaths& written);

/// The content of a plan as text, without the paths: for comparing versions of a plan that lie in different folders. The
/// hashes of its files are part of it.
std::string content_of(CasePlan plan);

}  // namespace tactus::plan

// SPDX-License-Identifier: Apache-2.0
// What the verbs of a plan share.
#pragma once

#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus::command {

struct PlanChoice {
    std::filesystem::path plan;
    std::vector<std::string> names;  ///< of fragments
    bool json = false;
};

/// The plan and --json.
void add_plan_options(VerbOptions& verb, PlanChoice& choice);
Option add_fragments(VerbOptions& verb, PlanChoice& choice, const char* about);

/// What the plan holds, for people or as JSON, on standard output.
int show_plan(const PlanChoice& choice);
/// After a change: programs are told what the plan holds now.
int show_change(const PlanChoice& choice);

}  // namespace tactus::command

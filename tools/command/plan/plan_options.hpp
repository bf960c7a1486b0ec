// SPDX-License-Identifier: Apache-2.0
// Options and output shared by the verbs of plans.
#pragma once

#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::command {

struct PlanChoice {
    std::filesystem::path plan;
    std::vector<std::string> names;  ///< names of fragments
    bool json = false;
    std::optional<double> kerf;  ///< mm of bone lost along the faces
    bool with_healthy = false;  ///< the plan's healthy side takes part in fits
};

/// The plan and --json.
void add_plan_options(VerbOptions& verb, PlanChoice& choice);
/// --kerf and --healthy, for the verbs that fit.
void add_fit_options(VerbOptions& verb, PlanChoice& choice);
analysis::FitWay fit_way(const PlanChoice& choice);
Option add_fragments(VerbOptions& verb, PlanChoice& choice, const char* about);

/// Prints the warnings of a plan, those that 'plan check' refuses first.
void print_warnings(const analysis::CaseWarnings& warnings);

/// Prints the plan as text or JSON on standard output.
int show_plan(const PlanChoice& choice);
/// Prints the plan after a change, with --json only; otherwise whether nothing had to be changed.
int show_change(const PlanChoice& choice, bool is_changed = true);

}  // namespace tactus::command

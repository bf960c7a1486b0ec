// SPDX-License-Identifier: Apache-2.0
// Options and output shared by the verbs of plans.
#pragma once

#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/command/result_options.hpp"
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
    ResultChoice result;
    std::optional<double> kerf;  ///< mm of bone lost along the faces
    bool with_healthy = false;  ///< the plan's healthy side takes part in fits
};

/// The plan and --json, for the verbs that change it.
void add_plan_options(VerbOptions& verb, PlanChoice& choice);
/// The plan and the options of results, for the verbs that report; returns -o. `product`: files that the verb makes
/// besides.
Option add_plan_report_options(VerbOptions& verb, PlanChoice& choice, Product product = {});
/// --kerf and --healthy, for the verbs that fit.
void add_fit_options(VerbOptions& verb, PlanChoice& choice);
/// Checks the files of -o before the plan is opened for a change: see check_result_files. The plan and its files are
/// sources, besides `sources`. Throws Error.
void check_plan_results(const PlanChoice& choice, std::vector<std::filesystem::path> sources = {},
                        const std::vector<std::filesystem::path>& others = {});
analysis::FitWay fit_way(const PlanChoice& choice);
Option add_fragments(VerbOptions& verb, PlanChoice& choice, const char* about);

/// Prints the plan, and writes its files.
int show_plan(const PlanChoice& choice);
/// Prints the plan after a change, with --json only; otherwise whether nothing had to be changed.
int show_change(const PlanChoice& choice, bool is_changed = true);

}  // namespace tactus::command

// SPDX-License-Identifier: Apache-2.0
// The verbs that keep the plan of a case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tactus {

struct PlanChoice {
    std::filesystem::path plan;
    std::vector<std::string> names;  ///< fragments, or files of a new plan ("NAME=FILE" or "FILE")
    std::string title, group, pose, alternative, from;
    std::string mode = "extended", paint = "auto", format = "stl";
    std::filesystem::path healthy, out;
    int steps = 1;
    bool settle = false, remove = false, json = false;
};

void add_plan_verbs(CLI::App& app, PlanChoice& choice);
/// Runs the verb of 'plan' that was given.
int plan_verb(const CLI::App& app, const PlanChoice& choice);

int plan_new(const PlanChoice& choice);
int plan_show(const PlanChoice& choice);
int plan_move(const PlanChoice& choice);
/// group, add, remove, ungroup, lock, unlock, hide, unhide: what is called `kind` in the plan.
int plan_arrange(const PlanChoice& choice, const std::string& verb);
int plan_undo(const PlanChoice& choice);
int plan_redo(const PlanChoice& choice);
int plan_alternative(const PlanChoice& choice);
int plan_snap(const PlanChoice& choice);
int plan_settle(const PlanChoice& choice);
int plan_mirror(const PlanChoice& choice);
int plan_gap(const PlanChoice& choice);
int plan_export(const PlanChoice& choice);
int plan_report(const PlanChoice& choice);

}  // namespace tactus

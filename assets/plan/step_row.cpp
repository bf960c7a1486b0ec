// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/step_row.hpp"

#include "dsp/core/error.hpp"
#include "dsp/fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tactus::plan {

const std::array<std::string_view, step_row_columns> step_row_names{
    "step", "after", "kind",  "by",      "left",  "fragment", "x",   "y",   "z",           "qw",     "qx",
    "qy",   "qz",    "other", "verdict", "score", "margin",   "rms", "gap", "penetration", "overlap"};

namespace {

constexpr double max_lost = 1000.0;  // lost steps tolerated before a row counts as invalid

int whole(double value, double low, double high, const char* what) {
    if (!(value >= low && value <= high) || value != std::floor(value))
        throw Error(fmt::format("steps of the run: {} is not a valid {}", value, what));
    return static_cast<int>(value);
}

/// "alternative 2", or the next free number; those of alternatives that may come back are not free.
std::string free_alternative_name(const CasePlan& plan, const std::vector<PlanAlternative>& dropped) {
    const auto has = [](const std::vector<PlanAlternative>& some, const std::string& name) {
        return std::ranges::find(some, name, &PlanAlternative::name) != some.end();
    };
    for (std::size_t n = plan.alternatives.size() + 1;; ++n)
        if (std::string name = fmt::format("alternative {}", n); !has(dropped, name) && !has(plan.alternatives, name))
            return name;
}

PlanStep step_of(const CasePlan& plan, const PlanState& state, std::span<const StepRow> rows, double second) {
    const auto last = static_cast<double>(plan.fragments.size()) - 1.0;
    const StepRow& first = rows.front();
    PlanStep step;
    step.kind = static_cast<StepKind>(whole(first.kind, 0.0, static_cast<double>(StepKind::show), "kind of step"));
    step.by = first.by > 0.5 ? "settle" : "hand";
    step.run_second = second;
    for (const StepRow& row : rows) {
        step.fragments.push_back(whole(row.fragment, 0.0, last, "fragment"));
        if (step.kind == StepKind::place) step.poses.push_back(row.pose());
    }
    const int other = whole(first.other, -1.0, last, "fragment");
    if (step.kind == StepKind::group) {
        if (other >= 0) step.fragments.push_back(other);
        step.group = free_group_name(state);
    }
    if (first.verdict >= 0.0 && other >= 0) {
        const auto verdict = static_cast<fit::FitVerdict>(whole(first.verdict, 0.0, 4.0, "verdict"));
        step.fit = PlanFit{plan.fragments[static_cast<std::size_t>(other)].name,
                           std::string(fit::name_of(verdict)),
                           first.score,
                           first.margin,
                           first.rms,
                           first.gap,
                           first.penetration,
                           first.overlap};
    }
    return step;
}

}  // namespace

RunSteps::RunSteps(CasePlan plan) : plan_(std::move(plan)), state_(state_of(plan_)), numbers_(plan_.steps.size()) {
    std::iota(numbers_.begin(), numbers_.end(), 0);
}

int RunSteps::head_of(double number, std::size_t count) const {
    const int n = whole(number, -1.0, static_cast<double>(count) - 1.0, "step before it");
    return n < 0 ? n : numbers_[static_cast<std::size_t>(n)];
}

void RunSteps::go(int head) {
    if (head == plan_.place().head) return;
    // Redo stays possible when the new position lies on the path to the tip.
    const auto before = plan_.before();
    const int tip = fit::is_on_way(before, head, plan_.place().tip) ? plan_.place().tip : head;
    state_ = state_of(plan_, head);
    plan_.place() = {head, tip};
}

void RunSteps::switch_to(double place) {
    const auto count = plan_.alternatives.size();
    const int n = whole(place, 0.0, static_cast<double>(count), "alternative");
    if (n == static_cast<int>(count))
        plan_.alternatives.push_back({free_alternative_name(plan_, dropped_), fit::after_step(plan_.place().head)});
    plan_.current = n;
    state_ = state_of(plan_);
}

void RunSteps::drop(double place) {
    const int n = whole(place, 0.0, static_cast<double>(plan_.alternatives.size()) - 1.0, "alternative");
    if (n == plan_.current) throw Error("steps of the run: the current alternative is not dropped");
    if (dropped_.size() == max_dropped) dropped_.erase(dropped_.begin());
    dropped_.push_back(plan_.alternatives[static_cast<std::size_t>(n)]);
    plan_.alternatives.erase(plan_.alternatives.begin() + n);
    plan_.current -= n < plan_.current;
}

void RunSteps::undrop() {
    if (dropped_.empty()) return;
    plan_.alternatives.push_back(std::move(dropped_.back()));
    dropped_.pop_back();
}

void RunSteps::finish_step(double second) {
    // Successors of a step that is left out follow its predecessor.
    numbers_.push_back(plan_.place().head);
    go(head_of(rows_.front().after, numbers_.size() - 1));
    numbers_.back() = plan_.place().head;
    add_step(plan_, state_, step_of(plan_, state_, rows_, second));
    numbers_.back() = plan_.place().head;
}

void RunSteps::add(const StepRow& row, double second) {
    // A step with a lost row is dropped.
    if (!rows_.empty() && (row.step != rows_.back().step || row.left != rows_.back().left - 1.0)) rows_.clear();
    if (row.kind == row_goes_to) return go(head_of(row.after, numbers_.size()));
    if (row.kind == row_alternative) return switch_to(row.after);
    if (row.kind == row_drop) return drop(row.after);
    if (row.kind == row_undrop) return undrop();
    const auto next = static_cast<double>(numbers_.size());
    numbers_.resize(static_cast<std::size_t>(whole(row.step, next, next + max_lost, "number of the next step")),
                    plan_.place().head);
    rows_.push_back(row);
    if (row.left > 0.0) return;
    try {
        finish_step(second);
    } catch (...) {
        rows_.clear();
        throw;
    }
    rows_.clear();
}

}  // namespace tactus::plan

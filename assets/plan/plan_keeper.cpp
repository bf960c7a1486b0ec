// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_keeper.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_files.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

namespace tactus::plan {

namespace fs = std::filesystem;

namespace {

/// True when `text` is a plan and `plan` contains all of its steps.
bool is_continued(const std::string& text, const CasePlan& plan) {
    try {
        CasePlan old = read_plan_text(text, "old");
        if (old.steps.size() > plan.steps.size()) return false;
        CasePlan begun = plan;
        begun.steps.resize(old.steps.size());
        // Compares steps and fragments only; paths and heads may differ.
        for (CasePlan* one : {&old, &begun}) {
            one->title.clear();
            one->alternatives = {{"main", {}}};
            one->current = 0;
        }
        return content_of(std::move(old)) == content_of(std::move(begun));
    } catch (const Error&) {
        return false;
    }
}

}  // namespace

PlanKeeper::PlanKeeper(CasePlan plan, fs::path file)
    : file_(std::move(file)), lock_(file_, std::chrono::milliseconds(500)), changed_(std::move(plan)) {
    move_old_aside();
    save();
}

void PlanKeeper::move_old_aside() {
    std::error_code failure;
    if (!fs::exists(file_, failure) || is_continued(file::read_whole_file(file_), changed_.plan())) return;
    for (int n = 1;; ++n) {
        const fs::path aside = fmt::format("{}.{}", file_.string(), n);
        if (fs::exists(aside, failure)) continue;
        fs::rename(file_, aside, failure);
        if (failure)
            throw Error(fmt::format("{}: the existing plan cannot be renamed: {}", file_.string(), failure.message()));
        return;
    }
}

void PlanKeeper::add(const PlanRecord& record, double second) {
    std::string trouble;
    if (record.number != next_)
        trouble = fmt::format("{} commands of the run did not reach the plan, before {:.3f} s", record.number - next_,
                              second);
    next_ = record.number + 1;
    try {
        is_saved_ = false;
        // The run has applied it already, so that it fails only after a loss.
        const PlanHistory::Outcome outcome = changed_.apply(record.command, {.run_second = second});
        if (outcome != PlanHistory::Outcome::done && trouble.empty())
            trouble = fmt::format("a command of the run at {:.3f} s is not in the plan: {}", second, text_of(outcome));
    } catch (const Error& error) {
        trouble = error.message();
    }
    if (trouble_.empty()) trouble_ = std::move(trouble);
}

void PlanKeeper::save() {
    if (is_saved_) return;
    save_case_plan(changed_.plan(), file_);
    is_saved_ = true;
}

void PlanKeeper::finish() {
    try {
        save();
    } catch (const Error& error) {
        const fs::path spare = fs::temp_directory_path() / fmt::format("{}.{}", ::getpid(), file_.filename().string());
        try {
            save_case_plan(changed_.plan(), spare);
        } catch (const Error& another) {
            throw Error(fmt::format("{}; {}", error.message(), another.message()));
        }
        throw Error(fmt::format("{}; the complete plan was saved to {}", error.message(), spare.string()));
    }
}

}  // namespace tactus::plan

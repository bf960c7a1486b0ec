// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_keeper.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>
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
        const auto bare = [](CasePlan& p) {
            p.title.clear();
            p.alternatives = {{"main", {}}};
            p.current = 0;
            for (PlanFragment& f : p.fragments) f.file.clear();
            for (PlanStep& step : p.steps) {
                if (step.mirror) step.mirror->file.clear();
                if (step.painted) step.painted->file.clear();
                if (!step.reconstruction) continue;
                auto all = std::make_shared<reconstruction::Reconstruction>(*step.reconstruction);
                all->donor.file.clear();
                if (all->jaw) all->jaw->file.clear();
                if (all->tumour) all->tumour->file.clear();
                step.reconstruction = std::move(all);
            }
        };
        bare(old);
        bare(begun);
        return plan_text(old) == plan_text(begun);
    } catch (const Error&) {
        return false;
    }
}

}  // namespace

PlanKeeper::PlanKeeper(CasePlan plan, fs::path file)
    : file_(std::move(file)), lock_(file_, std::chrono::milliseconds(500)), steps_(std::move(plan)) {
    move_old_aside();
    save();
}

void PlanKeeper::move_old_aside() {
    std::error_code failure;
    if (!fs::exists(file_, failure) || is_continued(file::read_whole_file(file_), steps_.plan())) return;
    for (int n = 1;; ++n) {
        const fs::path aside = fmt::format("{}.{}", file_.string(), n);
        if (fs::exists(aside, failure)) continue;
        fs::rename(file_, aside, failure);
        if (failure)
            throw Error(fmt::format("{}: the existing plan cannot be renamed: {}", file_.string(), failure.message()));
        return;
    }
}

void PlanKeeper::add(const StepRow& row, double second) {
    try {
        is_saved_ = false;
        steps_.add(row, second);
    } catch (const Error& error) {
        if (trouble_.empty()) trouble_ = error.message();
    }
}

void PlanKeeper::save() {
    if (is_saved_) return;
    save_case_plan(steps_.plan(), file_);
    is_saved_ = true;
}

void PlanKeeper::finish() {
    try {
        save();
    } catch (const Error& error) {
        const fs::path spare = fs::temp_directory_path() / fmt::format("{}.{}", ::getpid(), file_.filename().string());
        try {
            save_case_plan(steps_.plan(), spare);
        } catch (const Error& another) {
            throw Error(fmt::format("{}; {}", error.message(), another.message()));
        }
        throw Error(fmt::format("{}; the complete plan was saved to {}", error.message(), spare.string()));
    }
}

}  // namespace tactus::plan

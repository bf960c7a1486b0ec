// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/plan_document.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_lock.hpp"
#include "dsp/core/error.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/document/unsaved.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

// The window is blocked while it waits; other programs hold the lock for the duration of one step.
constexpr auto lock_patience = std::chrono::milliseconds(300);

}  // namespace

fs::path free_plan(const fs::path& folder) {
    for (int n = 1;; ++n)
        if (fs::path free = folder / fmt::format("changed-{}.plan.json", n); !fs::exists(free)) return free;
}

PlanDocument::PlanDocument(const fs::path& file) : file_(fs::absolute(file).lexically_normal()) {
    plan::CasePlan plan = plan::load_case_plan(file_);
    written_ = plan::make_files_absolute(plan, folder());
    set_saved(plan);
    set(std::move(plan));
}

PlanDocument::PlanDocument(std::shared_ptr<const plan::CasePlan> plan, const fs::path& file)
    : file_(fs::absolute(file).lexically_normal()) {
    set(*plan);
}

fs::path PlanDocument::folder() const { return file_.parent_path(); }

void PlanDocument::set(plan::CasePlan plan) {
    std::string content = plan::content_of(plan);
    if (plan_ && content == content_) return;
    content_ = std::move(content);
    plan_ = std::make_shared<const plan::CasePlan>(std::move(plan));
    is_saved_ = content_ == saved_content_;
    ++version_;
}

void PlanDocument::set_saved(plan::CasePlan plan) {
    saved_content_ = plan::content_of(plan);
    saved_ = std::move(plan);
    is_saved_ = content_ == saved_content_;
}

void PlanDocument::adopt(const std::shared_ptr<const plan::CasePlan>& newest) {
    if (!foreign_) return set(*newest);
    plan::CasePlan merged = *newest;
    plan::merge(merged, *foreign_, &*foreign_base_);
    // A version that has all steps of the other program goes on from the merged plan.
    if (plan::content_of(merged) == plan::content_of(*newest)) {
        foreign_.reset();
        return set(*newest);
    }
    set(std::move(merged));
}

bool PlanDocument::needs_name() const { return run::is_of_library(file_); }

void PlanDocument::write(const plan::CasePlan& plan) const {
    plan::CasePlan relative = plan;
    plan::make_files_relative(relative, folder(), written_);
    // A link stays one.
    plan::save_case_plan(relative, fs::is_symlink(file_) ? fs::canonical(file_) : file_);
}

/// What recovery files contain is saved.
void PlanDocument::remove_kept() noexcept {
    kept_.remove();
    std::error_code ignored;
    for (const fs::path& file : std::exchange(contained_, {}))
        if (!is_in_use(file)) fs::remove(file, ignored);
}

plan::MergedAlternatives PlanDocument::save() {
    if (needs_name())
        throw Error(fmt::format("{} belongs to the library and cannot be changed; save the plan under another name",
                                file_.string()));
    const plan::PlanLock lock(file_, lock_patience);
    plan::CasePlan merged = *plan_;
    plan::MergedAlternatives changed;
    if (fs::exists(file_)) {
        plan::CasePlan there = plan::load_case_plan(file_);
        written_.merge(plan::make_files_absolute(there, folder()));
        if (plan::content_of(there) != saved_content_) {
            changed = plan::merge(merged, there, &saved_);
            // Versions of the run that goes on do not have these steps.
            if (!foreign_) foreign_base_ = saved_;
            foreign_ = std::move(there);
            begins_again_ = true;
        }
    }
    write(merged);
    set(merged);
    set_saved(std::move(merged));
    remove_kept();
    return changed;
}

plan::MergedAlternatives PlanDocument::save_as(const fs::path& name, bool replaces) {
    const fs::path file = fs::absolute(name).lexically_normal();
    if (run::is_of_library(file))
        throw Error(fmt::format("{}: this file belongs to the library; choose another", file.string()));
    if (fs::exists(fs::symlink_status(file)) && !replaces)
        throw Error(fmt::format("{}: the file exists already; choose another name", file.string()));
    // Steps that another program has saved there meanwhile are merged, not replaced.
    if (std::error_code none; replaces && fs::equivalent(file, file_, none)) return save();
    const plan::PlanLock lock(file, lock_patience);
    const fs::path before = std::exchange(file_, file);
    const plan::WrittenPaths written = std::exchange(written_, {});
    try {
        write(*plan_);
    } catch (...) {
        file_ = before;
        written_ = written;
        throw;
    }
    set_saved(*plan_);
    remove_kept();
    return {};
}

EditedText PlanDocument::edited() const {
    return {file_, version_, is_saved_, [this] { return plan::plan_text(*plan_); }};
}

std::string PlanDocument::tend() {
    const std::string problem = kept_.tend(edited(), has_unsaved_steps());
    return problem.empty() ? problem : fmt::format("unsaved steps cannot be kept for a later window: {}", problem);
}

void PlanDocument::keep() noexcept {
    try {
        if (!has_unsaved_steps()) {
            if (!is_saved_) remove_kept();
            return;
        }
        const fs::path kept = kept_.keep(edited());
        dropped_version_ = version_;
        fmt::print(stderr, "tactus: unsaved steps of {} are kept in {}; the next window offers to restore them\n",
                   file_.string(), kept.string());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tactus: unsaved steps are lost: %s\n", error.what());
    }
}

fs::path PlanDocument::file_for_run(const fs::path& folder) {
    foreign_.reset();
    begins_again_ = false;
    if (is_saved_ && fs::exists(file_)) return file_;
    std::error_code none;
    if (!folder.empty() && fs::is_directory(folder, none)) {
        const fs::path copy = fs::absolute(free_plan(folder));
        plan::save_case_plan(*plan_, copy);
        return copy;
    }
    const fs::path kept = kept_.keep(edited());
    kept_.continue_with(kept);
    return fs::absolute(kept);
}

void PlanDocument::find_kept() {
    for (const fs::path& file : find_unsaved(file_)) try {
            if (is_in_use(file)) continue;
            if (plan::content_of(plan::load_case_plan(file)) == saved_content_) fs::remove(file);
            else offers_.push_back(file);
        } catch (const std::exception&) {
            // Damaged: restoring it reports why, and it stays.
            offers_.push_back(file);
        }
}

std::optional<fs::path> PlanDocument::offer() const {
    if (offers_.empty()) return std::nullopt;
    return offers_.back();
}

void PlanDocument::restore() {
    const fs::path file = offers_.back();
    plan::CasePlan plan = plan::load_case_plan(file);
    plan::make_files_absolute(plan, file.parent_path());
    // What another program has saved since is not lost.
    plan::merge(plan, saved_, nullptr);
    if (has_unsaved_steps()) {
        plan::merge(plan, *plan_, nullptr);
        // Also those steps that are too young to be in it.
        contained_.push_back(kept_.keep(edited()));
    }
    offers_.pop_back();
    kept_.continue_with(file);
    set(std::move(plan));
    begins_again_ = true;
}

void PlanDocument::discard_offer() {
    const fs::path file = offers_.back();
    offers_.pop_back();
    std::error_code failure;
    fs::remove(file, failure);
    if (failure) throw Error(fmt::format("{}: cannot be removed: {}", file.string(), failure.message()));
}

void PlanDocument::postpone_offer() {
    if (!offers_.empty()) offers_.pop_back();
}

}  // namespace tactus::window

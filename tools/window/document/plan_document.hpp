// SPDX-License-Identifier: Apache-2.0
// An opened plan: the document that runs and commands change, and that is saved. No user interface, no run.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "assets/plan/plan_files.hpp"
#include "assets/plan/plan_merge.hpp"
#include "tools/window/document/kept_edits.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::window {

/// A file that is not there, for a version of a plan that a run begins with: "changed-1.plan.json" and so on.
std::filesystem::path free_plan(const std::filesystem::path& folder);

class PlanDocument {
public:
    /// Reads the plan. Throws Error.
    explicit PlanDocument(const std::filesystem::path& file);
    /// A plan that is in no file of its own yet, as a run of an example has made it.
    PlanDocument(std::shared_ptr<const plan::CasePlan> plan, const std::filesystem::path& file);

    const std::filesystem::path& file() const { return file_; }
    std::filesystem::path folder() const;
    /// With absolute paths.
    const plan::CasePlan& plan() const { return *plan_; }
    const std::shared_ptr<const plan::CasePlan>& newest() const { return plan_; }
    /// Increases with every change.
    std::int64_t version() const { return version_; }

    /// The next version, with all steps of this one. Throws Error if it cannot be combined with steps that another program
    /// has saved; the document then stays as it is.
    void adopt(const std::shared_ptr<const plan::CasePlan>& newest);
    bool is_saved() const { return is_saved_; }
    /// Unsaved and not dropped.
    bool has_unsaved_steps() const { return !is_saved_ && version_ != dropped_version_; }
    void drop() { dropped_version_ = version_; }
    /// Revokes `drop`.
    void want() { dropped_version_ = -1; }

    /// The file cannot be changed: it belongs to the library.
    bool needs_name() const;
    /// Writes the plan under its lock. If another program has changed the file meanwhile, its steps are merged into the plan
    /// first (plan_merge.hpp); returns the alternatives that this has changed. Throws Error; the file then has its old
    /// content.
    plan::MergedAlternatives save();
    /// The same as another file, which is the document from now on. `replaces`: an existing file is overwritten, unless it
    /// is the document's own. Throws Error.
    plan::MergedAlternatives save_as(const std::filesystem::path& file, bool replaces);

    /// Once per picture: writes a new version to the recovery file, by another thread. Returns why that failed, once.
    std::string tend();
    /// Called at the end: keeps unsaved steps, and prints where on standard error.
    void keep() noexcept;
    /// The file with the present version, which a run begins with. `folder`: of the last run, empty if there was none.
    /// Throws Error.
    std::filesystem::path file_for_run(const std::filesystem::path& folder);
    /// True once when the plan contains steps that the run lacks: the run must be restarted.
    bool take_begin_again() { return std::exchange(begins_again_, false); }

    /// Finds recovery files of windows that ended without saving.
    void find_kept();
    std::optional<std::filesystem::path> offer() const;
    /// Unsaved steps of this window become an alternative beside the restored ones. Throws Error; the offer then stays.
    void restore();
    void discard_offer();
    void postpone_offer();

private:
    void set(plan::CasePlan plan);
    void set_saved(plan::CasePlan plan);
    void write(const plan::CasePlan& plan) const;
    void remove_kept() noexcept;
    EditedText edited() const;

    std::filesystem::path file_;
    plan::WrittenPaths written_;
    std::shared_ptr<const plan::CasePlan> plan_;
    plan::CasePlan saved_;  ///< as the file was read or written last
    std::string content_, saved_content_;
    std::optional<plan::CasePlan> foreign_;  ///< steps of another program, which a run that had begun does not have
    std::optional<plan::CasePlan> foreign_base_;
    bool is_saved_ = true, begins_again_ = false;
    std::int64_t version_ = 0, dropped_version_ = -1;
    KeptEdits kept_{std::chrono::milliseconds(0)};
    std::vector<std::filesystem::path> offers_;
    std::vector<std::filesystem::path> contained_;  ///< recovery files whose steps are all in the plan
};

}  // namespace tactus::window

// SPDX-License-Identifier: Apache-2.0
// Common to the studies of a plan: loading fragments, and adding steps.
#pragma once

#include "assets/plan/case_bones.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_history.hpp"
#include "assets/plan/plan_lock.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/fit/overlap.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace tactus::analysis {

/// A loaded fragment. It always has points. Its distances are only in `map`, and it has no density, because a whole
/// bone in fine voxels would need 100 MB for each.
struct CaseFragment : plan::FragmentBone {
    contact::Voxmap map;
};

/// Loads a fragment. Throws Error naming the fragment.
CaseFragment load_fragment(const plan::PlanFragment& fragment, const std::filesystem::path& folder,
                           plan::Paint paint = plan::Paint::as_filed);
/// Loads several fragments, two at a time, because parts of loading use one thread only. Calls `loaded` with the number of
/// those that are loaded, one call at a time. Throws Error naming the first that cannot be loaded.
std::vector<CaseFragment> load_each(std::span<const plan::PlanFragment> fragments, const std::filesystem::path& folder,
                                    plan::Paint paint = plan::Paint::as_filed,
                                    const std::function<void(std::size_t)>& loaded = {});
/// Loads all fragments of a plan. Throws Error for the first file that is missing or has changed.
std::vector<CaseFragment> load_fragments(const plan::CasePlan& plan, const std::filesystem::path& folder,
                                         plan::Paint paint = plan::Paint::as_filed);

/// Returns a fragment at a pose. The fragment must outlive the result.
fit::PlacedBone placed_bone(const CaseFragment& fragment, const Pose& pose);

/// Millimetres with two decimals; never "-0.00".
double shown_mm(double millimetres);

/// A plan that is locked for changes.
struct OpenPlan {
    plan::PlanLock lock;
    plan::CasePlan plan;

    explicit OpenPlan(const std::filesystem::path& path) : lock(path), plan(plan::load_case_plan(path)) {}
};

/// Applies a command to a plan, as a run and the window do, with the time of day. False: the plan is already so. Throws
/// Error if the command cannot be done, which names the fragment that cannot be moved.
bool apply_command(plan::CasePlan& plan, const plan::PlanCommand& command, plan::StepWords words);
/// The same, and saves the plan if it has changed.
bool change_plan(plan::CasePlan& plan, const plan::PlanCommand& command, plan::StepWords words,
                 const std::filesystem::path& path);

/// Adds a step that no command makes, as that of a reconstruction, with the time of day and saves the plan.
void do_step(plan::CasePlan& plan, plan::PlanStep step, const std::filesystem::path& path);

}  // namespace tactus::analysis

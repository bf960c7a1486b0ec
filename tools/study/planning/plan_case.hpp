// SPDX-License-Identifier: Apache-2.0
// Common to the studies of a plan: loading fragments, and adding steps.
#pragma once

#include "assets/cases/case_bones.hpp"
#include "assets/cases/plan_file.hpp"
#include "assets/cases/plan_lock.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/fit/overlap.hpp"

#include <filesystem>
#include <vector>

namespace tactus::study {

/// A loaded fragment. It always has points. Its distances are only in `map`, and it has no density, because a whole
/// bone in fine voxels would need 100 MB for each.
struct CaseFragment : cases::FragmentBone {
    contact::Voxmap map;
};

/// Loads a fragment. Throws Error naming the fragment.
CaseFragment load_fragment(const cases::PlanFragment& fragment, const std::filesystem::path& folder,
                           cases::Paint paint = cases::Paint::as_filed);
/// Loads all fragments of a plan. Throws Error for the first file that is missing or has changed.
std::vector<CaseFragment> load_fragments(const cases::CasePlan& plan, const std::filesystem::path& folder,
                                         cases::Paint paint = cases::Paint::as_filed);

/// Returns a fragment at a pose. The fragment must outlive the result.
fit::PlacedBone placed_bone(const CaseFragment& fragment, const Pose& pose);

/// Millimetres with two decimals; never "-0.00".
double shown_mm(double millimetres);

/// A plan that is locked for changes.
struct OpenPlan {
    cases::PlanLock lock;
    cases::CasePlan plan;

    explicit OpenPlan(const std::filesystem::path& path) : lock(path), plan(cases::load_case_plan(path)) {}
};

/// Adds a step with the time of day and saves the plan.
void do_step(cases::CasePlan& plan, cases::PlanStep step, const std::filesystem::path& path);

}  // namespace tactus::study

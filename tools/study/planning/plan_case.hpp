// SPDX-License-Identifier: Apache-2.0
// What the studies of a plan share: its fragments from their files, and its steps.
#pragma once

#include "assets/plan/case_bones.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_lock.hpp"
#include "dsp/contact/voxmap.hpp"

#include <filesystem>
#include <vector>

namespace tactus::study {

/// A fragment ready to be looked at. Its points are never empty.
struct CaseFragment : FragmentBone {
    Voxmap map;
};

/// From its file. Throws Error naming the fragment.
CaseFragment load_fragment(const PlanFragment& fragment, const std::filesystem::path& folder,
                           Paint paint = Paint::as_filed);
/// All of a plan. Throws Error for the first file that is missing or has changed.
std::vector<CaseFragment> load_fragments(const CasePlan& plan, const std::filesystem::path& folder,
                                         Paint paint = Paint::as_filed);

/// Millimetres to two decimals, without the sign of a zero.
double shown_mm(double millimetres);

/// A plan that is being changed: nobody else changes it meanwhile.
struct OpenPlan {
    PlanLock lock;
    CasePlan plan;

    explicit OpenPlan(const std::filesystem::path& path) : lock(path), plan(load_case_plan(path)) {}
};

/// Adds a step with the time of day and saves the plan.
void do_step(CasePlan& plan, PlanStep step, const std::filesystem::path& path);

}  // namespace tactus::study

// SPDX-License-Identifier: Apache-2.0
// What the studies of a plan share: its fragments from their files, and its steps.
#pragma once

#include "assets/cases/case_bones.hpp"
#include "assets/cases/plan_file.hpp"
#include "assets/cases/plan_lock.hpp"
#include "dsp/contact/voxmap.hpp"

#include <filesystem>
#include <vector>

namespace tactus::study {

/// A fragment ready to be looked at. Its points are never empty.
struct CaseFragment : cases::FragmentBone {
    contact::Voxmap map;
};

/// From its file. Throws Error naming the fragment.
CaseFragment load_fragment(const cases::PlanFragment& fragment, const std::filesystem::path& folder,
                           cases::Paint paint = cases::Paint::as_filed);
/// All of a plan. Throws Error for the first file that is missing or has changed.
std::vector<CaseFragment> load_fragments(const cases::CasePlan& plan, const std::filesystem::path& folder,
                                         cases::Paint paint = cases::Paint::as_filed);

/// Millimetres to two decimals, without the sign of a zero.
double shown_mm(double millimetres);

/// A plan that is being changed: nobody else changes it meanwhile.
struct OpenPlan {
    cases::PlanLock lock;
    cases::CasePlan plan;

    explicit OpenPlan(const std::filesystem::path& path) : lock(path), plan(cases::load_case_plan(path)) {}
};

/// Adds a step with the time of day and saves the plan.
void do_step(cases::CasePlan& plan, cases::PlanStep step, const std::filesystem::path& path);

}  // namespace tactus::study

// SPDX-License-Identifier: Apache-2.0
#include "tools/study/planning/plan_case.hpp"

#include "tools/study/workers.hpp"

#include <cmath>

namespace tactus::study {

CaseFragment load_fragment(const PlanFragment& fragment, const std::filesystem::path& folder, Paint paint) {
    CaseFragment loaded{fragment_bone(fragment, folder, paint, on_threads()), {}};
    loaded.map = make_voxmap(loaded.bone.distance);
    return loaded;
}

std::vector<CaseFragment> load_fragments(const CasePlan& plan, const std::filesystem::path& folder, Paint paint) {
    check_files(plan, folder);
    std::vector<CaseFragment> all;
    for (const PlanFragment& fragment : plan.fragments) all.push_back(load_fragment(fragment, folder, paint));
    return all;
}

double shown_mm(double millimetres) { return std::round(millimetres * 100.0) / 100.0 + 0.0; }

void do_step(CasePlan& plan, PlanStep step, const std::filesystem::path& path) {
    step.time = time_of_day();
    add_step(plan, std::move(step));
    save_case_plan(plan, path);
}

}  // namespace tactus::study

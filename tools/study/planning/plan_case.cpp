// SPDX-License-Identifier: Apache-2.0
#include "tools/study/planning/plan_case.hpp"

#include "dsp/core/stop.hpp"
#include "tools/study/workers.hpp"

#include <cmath>
#include <utility>

namespace tactus::study {

CaseFragment load_fragment(const cases::PlanFragment& fragment, const std::filesystem::path& folder,
                           cases::Paint paint) {
    CaseFragment loaded{cases::fragment_bone(fragment, folder, paint, on_threads(), cases::Contents::surface), {}};
    loaded.bone.density = {};
    loaded.map = contact::make_voxmap(std::exchange(loaded.bone.distance, {}), on_threads());
    return loaded;
}

std::vector<CaseFragment> load_fragments(const cases::CasePlan& plan, const std::filesystem::path& folder,
                                         cases::Paint paint) {
    cases::check_files(plan, folder);
    std::vector<CaseFragment> all;
    for (const cases::PlanFragment& fragment : cases::fragments_of(plan)) {
        leave_if_stopped();
        all.push_back(load_fragment(fragment, folder, paint));
    }
    return all;
}

fit::PlacedBone placed_bone(const CaseFragment& fragment, const Pose& pose) {
    return {fragment.bone.points, &fragment.map, pose, pose};
}

double shown_mm(double millimetres) { return std::round(millimetres * 100.0) / 100.0 + 0.0; }

void do_step(cases::CasePlan& plan, cases::PlanStep step, const std::filesystem::path& path) {
    step.time = cases::time_of_day();
    cases::add_step(plan, std::move(step));
    cases::save_case_plan(plan, path);
}

}  // namespace tactus::study

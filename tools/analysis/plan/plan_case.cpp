// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_case.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "tools/analysis/workers.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace tactus::analysis {

CaseFragment load_fragment(const plan::PlanFragment& fragment, const std::filesystem::path& folder, plan::Paint paint) {
    CaseFragment loaded{plan::fragment_bone(fragment, folder, paint, on_threads(), plan::Contents::surface), {}};
    loaded.bone.density = {};
    loaded.map = contact::make_voxmap(std::exchange(loaded.bone.distance, {}), on_threads());
    return loaded;
}

std::vector<CaseFragment> load_fragments(const plan::CasePlan& plan, const std::filesystem::path& folder,
                                         plan::Paint paint) {
    plan::check_files(plan, folder);
    std::vector<CaseFragment> all;
    for (const plan::PlanFragment& fragment : plan::fragments_of(plan)) {
        leave_if_stopped();
        all.push_back(load_fragment(fragment, folder, paint));
    }
    return all;
}

fit::PlacedBone placed_bone(const CaseFragment& fragment, const Pose& pose) {
    return {fragment.bone.points, &fragment.map, pose, pose};
}

double shown_mm(double millimetres) { return std::round(millimetres * 100.0) / 100.0 + 0.0; }

bool change_plan(plan::CasePlan& plan, const plan::PlanCommand& command, plan::StepWords words,
                 const std::filesystem::path& path) {
    using Outcome = plan::PlanHistory::Outcome;
    words.time = plan::time_of_day();
    const Outcome outcome = plan::change(plan, command, words);
    if (outcome == Outcome::unchanged) return false;
    if (outcome != Outcome::done) throw Error(std::string(plan::text_of(outcome)));
    plan::save_case_plan(plan, path);
    return true;
}

void do_step(plan::CasePlan& plan, plan::PlanStep step, const std::filesystem::path& path) {
    step.time = plan::time_of_day();
    plan::add_step(plan, std::move(step));
    plan::save_case_plan(plan, path);
}

}  // namespace tactus::analysis

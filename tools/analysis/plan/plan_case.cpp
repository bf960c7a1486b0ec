// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_case.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <variant>

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

namespace {

/// The fragment that a command moves; −1: it moves none.
int moved_by(const plan::PlanCommand& command) {
    if (const auto* place = std::get_if<plan::PlaceFragment>(&command)) return place->fragment;
    if (const auto* settle = std::get_if<plan::SettleFragment>(&command)) return settle->fragment;
    return -1;
}

}  // namespace

bool apply_command(plan::CasePlan& plan, const plan::PlanCommand& command, plan::StepWords words) {
    using Outcome = plan::PlanHistory::Outcome;
    words.time = plan::time_of_day();
    const Outcome outcome = plan::change(plan, command, words);
    if (outcome == Outcome::unchanged) return false;
    if (outcome == Outcome::done) return true;
    const int moved = moved_by(command);
    if (moved < 0 || moved >= static_cast<int>(plan.fragments.size())) throw Error(std::string(plan::text_of(outcome)));
    throw Error(fmt::format("'{}' cannot be moved: {}", plan.fragments[static_cast<std::size_t>(moved)].name,
                            plan::text_of(outcome)));
}

bool change_plan(plan::CasePlan& plan, const plan::PlanCommand& command, plan::StepWords words,
                 const std::filesystem::path& path) {
    if (!apply_command(plan, command, std::move(words))) return false;
    plan::save_case_plan(plan, path);
    return true;
}

void do_step(plan::CasePlan& plan, plan::PlanStep step, const std::filesystem::path& path) {
    step.time = plan::time_of_day();
    plan::add_step(plan, std::move(step));
    plan::save_case_plan(plan, path);
}

}  // namespace tactus::analysis

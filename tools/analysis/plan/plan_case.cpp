// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_case.hpp"

#include "dsp/core/error.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
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

std::vector<CaseFragment> load_each(std::span<const plan::PlanFragment> fragments, const std::filesystem::path& folder,
                                    plan::Paint paint, const std::function<void(std::size_t)>& loaded) {
    std::vector<CaseFragment> all(fragments.size());
    std::vector<std::exception_ptr> failures(fragments.size());
    std::mutex counting;
    std::size_t count = 0;
    std::atomic<bool> has_failed = false;
    on_threads(2)(static_cast<int>(fragments.size()), [&](int job) {
        const auto n = static_cast<std::size_t>(job);
        // Jobs start in order: the first that fails is always tried.
        if (has_failed) return;
        try {
            all[n] = load_fragment(fragments[n], folder, paint);
        } catch (...) {
            failures[n] = std::current_exception();
            has_failed = true;
            return;
        }
        const std::lock_guard lock(counting);
        ++count;
        if (loaded) loaded(count);
    });
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
    return all;
}

std::vector<CaseFragment> load_fragments(const plan::CasePlan& plan, const std::filesystem::path& folder,
                                         plan::Paint paint) {
    plan::check_files(plan, folder);
    return load_each(plan::fragments_of(plan), folder, paint);
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

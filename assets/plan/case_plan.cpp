// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/case_plan.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "assets/volume/file_hash.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <iterator>
#include <memory>

namespace tactus::plan {

namespace {

constexpr std::string_view kinds[] = {"place", "group", "add",    "remove",      "ungroup", "lock",   "unlock",
                                      "hide",  "show",  "mirror", "reconstruct", "repaint", "vessels"};

[[noreturn]] void refuse(const PlanStep& step, const std::string& why) {
    throw Error(fmt::format("step '{}': {}", name_of(step.kind), why));
}

void check_fragments(const CasePlan& plan, const PlanStep& step) {
    if (step.fragments.empty() && step.kind != StepKind::ungroup && step.kind != StepKind::mirror &&
        step.kind != StepKind::reconstruct && step.kind != StepKind::vessels)
        refuse(step, "names no fragment");
    for (std::size_t n = 0; n < step.fragments.size(); ++n) {
        const int fragment = step.fragments[n];
        if (fragment < 0 || static_cast<std::size_t>(fragment) >= plan.fragments.size())
            refuse(step, fmt::format("there is no fragment number {}", fragment));
        if (std::count(step.fragments.begin(), step.fragments.end(), fragment) > 1)
            refuse(step, fmt::format("names '{}' twice", plan.fragments[static_cast<std::size_t>(fragment)].name));
    }
}

int group_meant(const PlanStep& step, const PlanState& state) {
    const int group = state.find_group(step.group);
    if (group != fit::Arrangement::none) return group;
    std::vector<std::string> names;
    std::ranges::copy_if(state.group_names, std::back_inserter(names), [](const auto& n) { return !n.empty(); });
    refuse(step, fmt::format("there is no group '{}'{}", step.group, did_you_mean(step.group, names)));
}

constexpr double farthest = 100.0;  // m

void place(const CasePlan& plan, const PlanStep& step, PlanState& state) {
    if (step.poses.size() != step.fragments.size()) refuse(step, "does not have one pose per fragment");
    for (std::size_t n = 0; n < step.poses.size(); ++n) {
        const std::string& name = plan.fragments[static_cast<std::size_t>(step.fragments[n])].name;
        if (!is_valid(step.poses[n])) refuse(step, fmt::format("the pose of '{}' is not valid", name));
        if (!is_near(step.poses[n]))
            refuse(step, fmt::format("'{}' would lie more than {:.0f} m away; are the numbers in mm?", name, farthest));
        if (state.arrangement.is_locked(step.fragments[n])) refuse(step, fmt::format("'{}' is locked", name));
    }
    fit::Arrangement& a = state.arrangement;
    for (std::size_t n = 0; n < step.poses.size(); ++n) a.place(step.fragments[n], step.poses[n]);
    if (!step.fit) return;
    const auto partner = std::ranges::find(plan.fragments, step.fit->partner, &PlanFragment::name);
    a.fit(step.fragments[0], partner == plan.fragments.end() ? fit::Arrangement::none
                                                             : static_cast<int>(partner - plan.fragments.begin()));
    state.fits[static_cast<std::size_t>(step.fragments[0])] = step.fit;
}

void reconstruct(const CasePlan& plan, const PlanStep& step, PlanState& state) {
    if (!step.reconstruction) refuse(step, "has no reconstruction");
    fit::Arrangement& a = state.arrangement;
    // A change of the same reconstruction leaves alone what is shown.
    if (state.pieces != step.fragments) {
        for (const int piece : step.fragments) a.hide(piece, false);
        for (const PlanStep& other : plan.steps)
            if (other.kind == StepKind::reconstruct && other.fragments != step.fragments)
                for (const int piece : other.fragments)
                    if (std::ranges::find(step.fragments, piece) == step.fragments.end()) a.hide(piece, true);
    }
    state.reconstruction = step.reconstruction;
    state.pieces = step.fragments;
}

void repaint(const PlanStep& step, PlanState& state) {
    if (!step.painted) refuse(step, "has no file");
    if (step.fragments.size() != 1) refuse(step, "names more than one fragment");
    state.files[static_cast<std::size_t>(step.fragments[0])] = *step.painted;
}

void forget_groups_that_are_gone(PlanState& state) {
    for (std::size_t n = 0; n < state.group_names.size(); ++n)
        if (!state.arrangement.exists(static_cast<int>(n))) state.group_names[n].clear();
}

}  // namespace

bool is_near(const Pose& pose) noexcept {
    const Vec3 away = glm::abs(pose.position);
    return std::max({away.x, away.y, away.z}) <= farthest;
}

std::string_view name_of(StepKind kind) { return kinds[static_cast<std::size_t>(kind)]; }

std::vector<int> CasePlan::before() const {
    std::vector<int> all;
    all.reserve(steps.size());
    for (const PlanStep& step : steps) all.push_back(step.before);
    return all;
}

int PlanState::find_group(std::string_view name) const {
    if (name.empty()) return fit::Arrangement::none;
    const auto found = std::ranges::find(group_names, name);
    return found == group_names.end() ? fit::Arrangement::none : static_cast<int>(found - group_names.begin());
}

void apply(const CasePlan& plan, const PlanStep& step, PlanState& state) {
    check_fragments(plan, step);
    fit::Arrangement& a = state.arrangement;
    switch (step.kind) {
        case StepKind::place: place(plan, step, state); break;
        case StepKind::group: {
            if (step.group.empty()) refuse(step, "the group has no name");
            if (state.find_group(step.group) != fit::Arrangement::none)
                refuse(step, fmt::format("the group '{}' exists already", step.group));
            const int made = a.join(step.fragments);
            if (made == fit::Arrangement::none) refuse(step, "needs two fragments that do not move together already");
            state.group_names[static_cast<std::size_t>(made)] = step.group;
            break;
        }
        case StepKind::add: {
            const int group = group_meant(step, state);
            for (const int fragment : step.fragments)
                if (!a.add(group, fragment))
                    refuse(step, fmt::format("'{}' is part of '{}' already",
                                             plan.fragments[static_cast<std::size_t>(fragment)].name, step.group));
            break;
        }
        case StepKind::remove:
            for (const int fragment : step.fragments)
                if (!a.remove(fragment))
                    refuse(step,
                           fmt::format("'{}' is in no group", plan.fragments[static_cast<std::size_t>(fragment)].name));
            break;
        case StepKind::ungroup: a.dissolve(group_meant(step, state)); break;
        case StepKind::lock:
        case StepKind::unlock:
            for (const int fragment : step.fragments) a.lock(fragment, step.kind == StepKind::lock);
            break;
        case StepKind::hide:
        case StepKind::show:
            for (const int fragment : step.fragments) a.hide(fragment, step.kind == StepKind::hide);
            break;
        case StepKind::mirror:
            if (!step.mirror) refuse(step, "has no target");
            state.mirror = step.mirror;
            break;
        case StepKind::reconstruct: reconstruct(plan, step, state); break;
        case StepKind::repaint: repaint(step, state); break;
        case StepKind::vessels:
            if (!step.vessels) refuse(step, "has no vessels");
            state.vessels = step.vessels;
            break;
    }
    forget_groups_that_are_gone(state);
}

namespace {

PlanState as_scanned(const CasePlan& plan) {
    const fit::Arrangement arrangement(plan.fragments.size());
    std::vector<HashedFile> files;
    for (const PlanFragment& fragment : plan.fragments) files.push_back({fragment.file, fragment.hash});
    return {arrangement,
            std::vector<std::string>(arrangement.max_groups()),
            std::vector<std::optional<PlanFit>>(plan.fragments.size()),
            std::nullopt,
            {},
            {},
            std::move(files),
            {}};
}

}  // namespace

void visit_steps(const CasePlan& plan, const std::function<void(int, const PlanState&, const PlanState&)>& visit) {
    const std::vector<int> before = plan.before();
    // Per step, with the start as number 0: its direct successors, and the number of all steps after it.
    std::vector<std::vector<int>> next(before.size() + 1);
    std::vector<std::size_t> following(before.size() + 1, 0);
    const auto slot = [](int step) { return static_cast<std::size_t>(step + 1); };
    for (std::size_t n = before.size(); n-- > 0;) following[slot(before[n])] += following[n + 1] + 1;
    for (std::size_t n = 0; n < before.size(); ++n) next[slot(before[n])].push_back(static_cast<int>(n));
    struct Open {
        std::shared_ptr<const PlanState> from;
        int step;
    };
    std::vector<Open> open;
    // The largest branch is visited last: then few states are stored at a time for every shape of tree.
    const auto reach = [&](const std::shared_ptr<const PlanState>& state, int at) {
        auto& steps = next[slot(at)];
        std::ranges::stable_sort(steps, std::ranges::greater{}, [&](int n) { return following[slot(n)]; });
        for (const int n : steps) open.push_back({state, n});
    };
    reach(std::make_shared<PlanState>(as_scanned(plan)), -1);
    while (!open.empty()) {
        const Open now = std::move(open.back());
        open.pop_back();
        auto to = std::make_shared<PlanState>(*now.from);
        try {
            apply(plan, plan.steps[static_cast<std::size_t>(now.step)], *to);
        } catch (const Error& error) {
            throw Error(fmt::format("step {} cannot be applied: {}", now.step, error.message()));
        }
        visit(now.step, *now.from, *to);
        reach(to, now.step);
    }
}

PlanState state_of(const CasePlan& plan, int head) {
    PlanState state = as_scanned(plan);
    for (const int n : fit::steps_to(plan.before(), head)) apply(plan, plan.steps[static_cast<std::size_t>(n)], state);
    return state;
}

PlanState state_of(const CasePlan& plan) { return state_of(plan, plan.place().head); }

void add_step(CasePlan& plan, PlanStep step) {
    PlanState state = state_of(plan);
    add_step(plan, state, std::move(step));
}

void add_step(CasePlan& plan, PlanState& state, PlanStep step) {
    PlanState next = state;
    apply(plan, step, next);
    state = std::move(next);
    step.before = plan.place().head;
    plan.steps.push_back(std::move(step));
    plan.place() = fit::after_step(static_cast<int>(plan.steps.size()) - 1);
}

std::vector<PlanFragment> fragments_of(const CasePlan& plan, const PlanState& state) {
    std::vector<PlanFragment> all = plan.fragments;
    for (std::size_t n = 0; n < all.size(); ++n) {
        all[n].file = state.files[n].file;
        all[n].hash = state.files[n].hash;
    }
    return all;
}

std::vector<PlanFragment> fragments_of(const CasePlan& plan) { return fragments_of(plan, state_of(plan)); }

std::string free_group_name(const PlanState& state) {
    for (int n = 1;; ++n)
        if (std::string name = fmt::format("group_{}", n); state.find_group(name) == fit::Arrangement::none)
            return name;
}

int find_fragment(const CasePlan& plan, std::string_view name) {
    const auto found = std::ranges::find(plan.fragments, name, &PlanFragment::name);
    if (found != plan.fragments.end()) return static_cast<int>(found - plan.fragments.begin());
    std::vector<std::string> names;
    for (const PlanFragment& fragment : plan.fragments) names.push_back(fragment.name);
    throw Error(fmt::format("the plan has no fragment '{}'{}", name, did_you_mean(name, names)));
}

std::filesystem::path file_of(const std::string& file, const std::filesystem::path& folder) {
    const std::filesystem::path path = file;
    return path.is_absolute() ? path : folder / path;
}

void add_fragment(CasePlan& plan, const std::string& name, const std::filesystem::path& file,
                  const std::filesystem::path& folder, const Vec3& colour) {
    if (name.empty()) throw Error(fmt::format("{}: the fragment has no name", file.string()));
    if (std::ranges::find(plan.fragments, name, &PlanFragment::name) != plan.fragments.end())
        throw Error(fmt::format("{}: the plan has a fragment '{}' already; choose another name, as in NAME={}",
                                file.string(), name, file.string()));
    Hash hash;
    volume::add_file_with_samples(hash, bone::file_of_bone(file));
    std::error_code failure;
    const auto absolute = std::filesystem::weakly_canonical(file, failure),
               home = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, failure);
    const auto relative = absolute.lexically_relative(home);
    const bool is_below = !relative.empty() && *relative.begin() != "..";
    plan.fragments.push_back({name, is_below ? relative.string() : absolute.string(), hash.value(), colour});
}

namespace {

/// Calls visit(what, file, hash) for each file that the current state of a plan needs.
template <class Visit>
void visit_files(const CasePlan& plan, const Visit& visit) {
    const PlanState state = state_of(plan);
    for (const PlanFragment& fragment : fragments_of(plan, state))
        visit("fragment '" + fragment.name + "'", fragment.file, fragment.hash);
    if (state.mirror) visit("mirror target", state.mirror->file, state.mirror->hash);
    if (const auto& all = state.reconstruction) {
        visit("donor", all->donor.file, all->donor.hash);
        if (all->jaw) visit("jaw", all->jaw->file, all->jaw->hash);
        if (all->tumour) visit("tumour", all->tumour->file, all->tumour->hash);
    }
}

}  // namespace

std::vector<std::filesystem::path> files_of(const CasePlan& plan, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    visit_files(plan, [&](const std::string&, const std::string& file, std::uint64_t) {
        files.push_back(bone::file_of_bone(file_of(file, folder)));
    });
    return files;
}

std::vector<std::string> changed_files(const CasePlan& plan, const std::filesystem::path& folder) {
    std::vector<std::string> problems;
    visit_files(plan, [&](const std::string& what, const std::string& file, std::uint64_t hash) {
        Hash now;
        try {
            volume::add_file_with_samples(now, bone::file_of_bone(file_of(file, folder)));
        } catch (const Error&) {
            problems.push_back(fmt::format("{}: its file {} is missing", what, file_of(file, folder).string()));
            return;
        }
        if (now.value() != hash)
            problems.push_back(fmt::format("{}: its file {} has changed since the plan was made", what,
                                           file_of(file, folder).string()));
    });
    return problems;
}

}  // namespace tactus::plan

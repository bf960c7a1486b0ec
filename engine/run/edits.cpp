// SPDX-License-Identifier: Apache-2.0
// Changing what runs. A plan is built aside and handed to every group; each takes it over at the same logical time.
// The old plan is taken apart when no group can touch it any more.
#include "engine/run/engine.hpp"

#include "dsp/core/error.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <unordered_set>

namespace tactus::run {

namespace {

// How far ahead of the furthest group the switch lies.
constexpr Flicks switch_lead = flicks_per_second / 20;

}  // namespace

Flicks Engine::furthest() const {
    Flicks furthest = 0;
    for (const auto& group : now_->groups) furthest = std::max(furthest, group->done() * group->plan->period);
    return furthest;
}

void Engine::edit(std::function<compile::Plan()> make, std::function<void(const EditOutcome&)> told) {
    waiting_ = WaitingEdit{std::move(make), std::move(told)};
}

void Engine::service_edits() {
    retire();
    if (building_.valid()) {
        if (building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        try {
            hand_over(building_.get());
        } catch (const std::exception& error) {
            host_.discard();
            EditOutcome outcome;
            outcome.error = error.what();
            if (making_->told) making_->told(outcome);
        }
        making_.reset();
        return;
    }
    if (!waiting_ || before_) return;
    making_ = std::exchange(waiting_, std::nullopt);
    building_ = std::async(std::launch::async, [this] {
        compile::Plan plan = making_->make();
        // A take numbers groups and links in the order in which plans were taken up: those that fail leave no gap.
        const int group = context_.next_group, link = context_.next_link;
        try {
            host_.begin(plan.patch);
            return build::build_generation(std::move(plan), now_.get(), context_);
        } catch (...) {
            context_.next_group = group;
            context_.next_link = link;
            throw;
        }
    });
}

void Engine::hand_over(std::unique_ptr<build::Generation> next) {
    const Flicks when = furthest() + switch_lead;
    if (seconds(when) >= options_.seconds) throw Error("the run is over before the edit could take effect");
    keep_opened();
    if (options_.take) options_.take->edit(next->number, when, next->plan.patch);
    const std::size_t known = groups_.size();
    adopt_groups(*next, when);
    for (std::size_t g = 0; g < next->groups.size(); ++g) {
        GroupRuntime& group = *next->groups[g];
        if (next->group_is_new[g]) group.scheduled.push_back(next->programs[g].get());
        else group.hand_over(next->programs[g].get());
    }
    for (std::size_t g = known; g < groups_.size(); ++g) start_thread(*groups_[g]);
    EditOutcome outcome{{}, next->number, when, 0, next->nodes.size()};
    outcome.kept = static_cast<std::size_t>(std::ranges::count(next->survived, true));
    before_ = std::exchange(now_, std::move(next));
    settled_at_.clear();
    if (making_->told) making_->told(outcome);
}

/// Takes the plan before apart once every group has left it and completed a call since.
void Engine::retire() {
    if (!before_) return;
    for (const auto& group : groups_) {
        const bool has_left = now_->keeps(group.get()) && group->generation() >= now_->number;
        if (!has_left && !group->is_over()) return;
    }
    if (!now_->settled()) return;
    if (settled_at_.empty()) {
        for (const auto& group : groups_) settled_at_.push_back(group->done());
        return;
    }
    for (std::size_t g = 0; g < groups_.size(); ++g)
        if (groups_[g]->done() <= settled_at_[g] && !groups_[g]->is_over()) return;
    gather_hashes(*before_, now_.get(), ended_hashes_);
    before_.reset();
    for (const auto& link : now_->links) link->forget_continued();
    close_ended();
}

/// Gives back what only the plan before used: threads, logs and recordings of groups and nodes that are no more. A run
/// may be edited for days.
void Engine::close_ended() {
    std::vector<GroupRuntime*> ended;
    for (const auto& group : groups_)
        if (group->is_over() && group->log) ended.push_back(group.get());
    drain_log();  // with the last that they said
    for (GroupRuntime* group : ended) {
        const std::lock_guard lock(log_lock_);
        std::erase_if(log_rings_, [&](const auto& ring) { return ring.get() == group->log; });
        group->log = nullptr;
    }
    for (const auto& group : groups_)
        if (group->is_over()) end_thread(*group);
    for (const auto& [name, tap] : taps_)
        if (tap.stream && tap.group->is_over()) tap.stream->finish();
    for (const Tap& tap : ending_taps_)
        if (tap.stream && tap.group->is_over()) tap.stream->finish();
    list_open_taps();
    std::unordered_set<const RecordStream*> in_use;
    for (const auto& node : now_->nodes) in_use.insert(node->uses.streams.begin(), node->uses.streams.end());
    for (const auto& stream : host_.streams)
        if (!in_use.contains(stream.get())) stream->finish();
}

Flicks Engine::set(const std::string& given_node, const std::string& given_param, const std::string& text) {
    const auto [node, param] = patch::end_within(now_->plan.patch, given_node, given_param);
    std::vector<std::string> names;
    for (const auto& live : now_->nodes) names.push_back(live->name);
    const int at = now_->find(node);
    if (at < 0) throw Error(fmt::format("no node '{}'{}", node, did_you_mean(node, names)));
    build::LiveNode& live = *now_->nodes[static_cast<std::size_t>(at)];
    names.clear();
    for (const auto& [name, known] : live.params) names.push_back(name);
    const auto found = live.params.find(param);
    if (found == live.params.end())
        throw Error(fmt::format("node '{}' has no parameter '{}' that is a quantity{}", node, param,
                                did_you_mean(param, names)));
    if (found->second->is_structural)
        throw Error(fmt::format("'{}.{}' is structural: change it in the patch", node, param));
    const auto& compiled = now_->plan.nodes[static_cast<std::size_t>(at)].params.at(param);
    for (const compile::PlanWire& wire : now_->plan.wires)
        if (wire.to_node == at && wire.to_input < 0 && wire.param == compiled)
            throw Error(fmt::format("'{}.{}' is driven by a wire", node, param));
    const double value = found->second->parse(text);
    const Flicks when = furthest() + 2 * now_->plan.patch.quantum;
    const ParameterChange change{changes_++, when, found->second, value};
    if (options_.take) options_.take->change(change.id, now_->number, node, param, value);
    if (!live.group->hand_over(change)) throw Error("too many changes are waiting already");
    return when;
}

}  // namespace tactus::run

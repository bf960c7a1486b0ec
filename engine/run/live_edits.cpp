// SPDX-License-Identifier: Apache-2.0
#include "engine/run/live_edits.hpp"

#include "dsp/core/error.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace tactus::run {

namespace {

// How far ahead of the furthest group the switch lies.
constexpr Flicks switch_lead = flicks_per_second / 20;

}  // namespace

void LiveEdits::edit(std::function<compile::Plan()> make, std::function<void(const EditOutcome&)> told) {
    waiting_ = Edit{std::move(make), std::move(told)};
}

void LiveEdits::service(const Threads& threads) {
    retire(threads);
    if (!building_.valid()) {
        if (waiting_ && !timeline_.is_changing()) build();
        return;
    }
    if (building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    try {
        hand_over(building_.get(), threads);
    } catch (const std::exception& error) {
        context_.host.discard();
        EditOutcome outcome;
        outcome.error = error.what();
        if (making_->told) making_->told(outcome);
    }
    making_.reset();
}

void LiveEdits::build() {
    making_ = std::exchange(waiting_, std::nullopt);
    building_ = std::async(std::launch::async, [this] {
        compile::Plan plan = making_->make();
        // A take numbers groups and links in the order in which plans were taken up: those that fail leave no gap.
        const int group = context_.next_group, link = context_.next_link;
        try {
            return timeline_.build_next(std::move(plan));
        } catch (...) {
            context_.next_group = group;
            context_.next_link = link;
            throw;
        }
    });
}

void LiveEdits::hand_over(std::unique_ptr<build::Generation> next, const Threads& threads) {
    const Flicks when = timeline_.furthest() + switch_lead;
    if (seconds(when) >= seconds_) throw Error("the run is over before the edit could take effect");
    recorder_.keep_opened();
    if (take::TakeWriter* take = recorder_.take()) take->edit(next->number, when, next->plan.patch);
    EditOutcome outcome{{}, next->number, when, 0, next->nodes.size()};
    outcome.kept = static_cast<std::size_t>(std::ranges::count(next->survived, true));
    for (GroupRuntime* group : timeline_.hand_over(std::move(next), when)) threads.start(*group);
    settled_at_.clear();
    if (making_->told) making_->told(outcome);
}

void LiveEdits::retire(const Threads& threads) {
    if (!timeline_.is_changing() || !is_before_left()) return;
    timeline_.retire();
    close_ended(threads);
}

bool LiveEdits::is_before_left() {
    const build::Generation& now = timeline_.now();
    const auto& groups = timeline_.groups();
    for (const auto& group : groups) {
        const bool has_left = now.keeps(group.get()) && group->plan_number() >= now.number;
        if (!has_left && !group->is_over()) return false;
    }
    if (!now.settled()) return false;
    if (settled_at_.empty()) {
        for (const auto& group : groups) settled_at_.push_back(group->done());
        return false;
    }
    for (std::size_t g = 0; g < groups.size(); ++g)
        if (groups[g]->done() <= settled_at_[g] && !groups[g]->is_over()) return false;
    return true;
}

/// Gives back what only the plan before used: threads, logs and recordings of groups and nodes that are no more. A run
/// may be edited for days.
void LiveEdits::close_ended(const Threads& threads) {
    std::vector<GroupRuntime*> ended;
    for (const auto& group : timeline_.groups())
        if (group->is_over() && group->log.ring) ended.push_back(group.get());
    recorder_.drain_journal(timeline_.groups());  // with their last records
    for (GroupRuntime* group : ended) recorder_.detach(*group);
    for (const auto& group : timeline_.groups())
        if (group->is_over()) threads.end(*group);
    recorder_.finish_ended(timeline_);
}

void LiveEdits::wait() const {
    if (building_.valid()) building_.wait();
}

Flicks LiveEdits::set(const std::string& given_node, const std::string& given_param, const std::string& text) {
    const build::Generation& now = timeline_.now();
    const auto [node, param] = patch::end_within(now.plan.patch, given_node, given_param);
    std::vector<std::string> names;
    for (const auto& live : now.nodes) names.push_back(live->name);
    const int at = now.find(node);
    if (at < 0) throw Error(fmt::format("no node '{}'{}", node, did_you_mean(node, names)));
    build::LiveNode& live = *now.nodes[static_cast<std::size_t>(at)];
    names.clear();
    for (const auto& [name, known] : live.params) names.push_back(name);
    const auto found = live.params.find(param);
    if (found == live.params.end())
        throw Error(fmt::format("node '{}' has no parameter '{}' that is a quantity{}", node, param,
                                did_you_mean(param, names)));
    if (found->second->is_structural)
        throw Error(fmt::format("'{}.{}' is structural: change it in the patch", node, param));
    const auto& compiled = now.plan.nodes[static_cast<std::size_t>(at)].params.at(param);
    for (const compile::PlanWire& wire : now.plan.wires)
        if (wire.to_node == at && wire.to_input < 0 && wire.param == compiled)
            throw Error(fmt::format("'{}.{}' is driven by a wire", node, param));
    const double value = found->second->parse(text);
    const Flicks when = timeline_.furthest() + 2 * now.plan.patch.quantum;
    const ParameterChange change{changes_++, when, found->second, value};
    if (take::TakeWriter* take = recorder_.take()) take->change(change.id, now.number, node, param, value);
    if (!live.group->hand_over(change)) throw Error("too many changes are waiting already");
    return when;
}

}  // namespace tactus::run

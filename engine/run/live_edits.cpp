// SPDX-License-Identifier: Apache-2.0
#include "engine/run/live_edits.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "engine/build/force_path.hpp"
#include "engine/run/made_thread.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace tactus::run {

namespace {

// From setting a parameter to the first activation for which it may hold.
constexpr Flicks set_lead = flicks_per_second * 3 / 1000;
constexpr Flicks fade_notice = flicks_per_second / 1000;  // to the first activation that fades
constexpr std::int64_t longest_wait_ns = 200'000'000;

}  // namespace

LiveEdits::~LiveEdits() {
    if (building_ && building_->thread.joinable()) building_->thread.join();
}

void LiveEdits::edit(std::function<compile::Schedule()> make, std::function<void(const EditOutcome&)> told) {
    waiting_ = Edit{std::move(make), std::move(told)};
}

void LiveEdits::service(const Threads& threads) {
    retire(threads);
    if (building_) {
        if (building_->is_done) finish(threads);
    } else if (waiting_ && !timeline_.is_changing()) build();
}

void LiveEdits::tell(const EditOutcome& outcome) const {
    if (making_->told) making_->told(outcome);
}

void LiveEdits::finish(const Threads& threads) {
    const std::unique_ptr<Building> built = std::exchange(building_, nullptr);
    built->thread.join();
    const int group = context_.group_before, link = context_.link_before;
    EditOutcome outcome;
    try {
        if (built->failure) std::rethrow_exception(built->failure);
        outcome = hand_over(*built, threads);
    } catch (const std::exception& error) {
        threads.cancel();
        built->made.reset();
        context_.host.discard();
        // A take numbers groups and links in the order in which plans were taken up: those that fail leave no gap.
        context_.next_group = group;
        context_.next_link = link;
        outcome.error = error.what();
    }
    tell(outcome);
    making_.reset();
}

void LiveEdits::build() {
    making_ = std::exchange(waiting_, std::nullopt);
    context_.group_before = context_.next_group;
    context_.link_before = context_.next_link;
    building_ = std::make_unique<Building>();
    try {
        building_->thread = made_thread(
            "to build the plan",
            [this, building = building_.get(), is_taken = recorder_.take() != nullptr] { work(*building, is_taken); });
    } catch (const std::system_error& error) {
        building_.reset();
        EditOutcome outcome;
        outcome.error = error.what();
        tell(outcome);
        making_.reset();
    }
}

/// Thread that builds. All that takes long is done here: the control thread and the switch do not wait for it.
void LiveEdits::work(Building& building, bool is_taken) {
    try {
        building.made = timeline_.build_next(making_->make());
        if (is_taken) building.assets = take::TakeWriter::describe_assets(building.made->plan.patch);
    } catch (...) {
        building.made.reset();
        building.failure = std::current_exception();
    }
    building.is_done = true;
}

EditOutcome LiveEdits::hand_over(Building& built, const Threads& threads) {
    build::Generation& next = *built.made;
    const Flicks lead = Timeline::lead_of(next);
    if (seconds(present_.now() + lead) >= seconds_) throw Error("the run is over before the edit could take effect");
    threads.prepare(next);
    recorder_.keep_opened();
    // Nothing that may take long comes between choosing the time and telling all groups.
    const Flicks when = present_.now() + lead;
    timeline_.hand_over(std::move(built.made), when);
    threads.release();
    const bool is_described = !built.assets.empty();
    if (take::TakeWriter* take = recorder_.take(); take && is_described)
        take->edit(next.number, when, next.plan.patch, built.assets);
    settled_at_.clear();
    given_before_.clear();
    for (const auto& group : timeline_.groups())
        if (!group->is_over()) given_before_.emplace_back(group, group->changes_given());
    EditOutcome outcome{{}, next.number, when, 0, next.nodes.size()};
    outcome.kept = static_cast<std::size_t>(std::ranges::count(next.survived, true));
    return outcome;
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
    for (const auto& [group, given] : given_before_)
        if (group->changes_applied() < given && !group->is_over()) return false;
    if (!now.settled()) return false;
    if (settled_at_.empty()) {
        for (const auto& group : groups) settled_at_.push_back(group->rests());
        return false;
    }
    for (std::size_t g = 0; g < groups.size(); ++g)
        if (groups[g]->rests() <= settled_at_[g] && !groups[g]->is_over()) return false;
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
    // Every reference to groups that are no more is gone: threads, rings of the journal, the plan before.
    given_before_.clear();
    timeline_.forget_ended();
}

bool LiveEdits::end() {
    if (!building_) return true;
    const std::int64_t give_up = steady_ns() + longest_wait_ns;
    while (!building_->is_done) {
        if (steady_ns() > give_up && context_.host.forsake_driver()) {
            building_->thread.detach();
            return false;
        }
        sleep_for(1'000'000);
    }
    building_->thread.join();
    building_.reset();
    return true;
}

Flicks LiveEdits::lead_of_set(const build::Generation& now, std::size_t node, const Param& param) {
    if (!param.is_discrete || param.is_trigger) return set_lead;
    const auto reach = build::reach_of(now, node);
    if (!reach) return set_lead;
    PauseWindow& window = time_.window;
    const Flicks begin = present_.now() + fade_notice, lead = fade_notice + Timeline::fade_lead(reach->device_period);
    const bool is_off = window.set_fade.load() <= begin && begin < window.set_until.load();
    const Flicks until = begin + lead + reach->latency;
    // In this order: at no time does the window seem to be without an end, or to be over.
    window.set_until = is_off ? std::max(until, window.set_until.load()) : until;
    if (!is_off) window.set_fade = begin;
    return lead;
}

LiveEdits::Setting LiveEdits::setting_of(const std::string& node, const std::string& param,
                                         const std::string& text) const {
    const build::Generation& now = timeline_.now();
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
    for (const compile::ScheduleWire& wire : now.plan.wires)
        if (wire.to_node == at && wire.to_input < 0 && wire.param == compiled)
            throw Error(fmt::format("'{}.{}' is driven by a wire", node, param));
    // The group's thread may change the range of the live parameter when it takes the plan over.
    return {static_cast<std::size_t>(at), &live, found->second, compiled->parse(text)};
}

Flicks LiveEdits::set(const std::string& given_node, const std::string& given_param, const std::string& text) {
    const build::Generation& now = timeline_.now();
    const std::vector<patch::NamedEnd> ends = patch::ends_within(now.plan.patch, given_node, given_param);
    std::vector<Setting> settings;  // all are checked before the first one is made
    for (const patch::NamedEnd& end : ends) settings.push_back(setting_of(end.node, end.name, text));
    Flicks lead = set_lead;
    for (const Setting& one : settings) lead = std::max(lead, lead_of_set(now, one.index, *one.param));
    const Flicks when = present_.now() + lead;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Setting& one = settings[i];
        const ParameterChange change{changes_++, when, one.param, one.value, now.ramp_of(one.param)};
        if (take::TakeWriter* take = recorder_.take())
            take->change(change.id, now.number, ends[i].node, ends[i].name, one.value);
        if (!one.node->group->hand_over(change)) throw Error("too many changes are waiting already");
    }
    return when;
}

}  // namespace tactus::run

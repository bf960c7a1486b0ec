// SPDX-License-Identifier: Apache-2.0
#include "engine/run/timeline.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "engine/run/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::run {

namespace {

/// From handing a plan over to the first tick that fades.
constexpr Flicks notice_lead = flicks_per_second * 30 / 1000;

std::int64_t tick_at(double time, Flicks period) {
    const double ticks = time * static_cast<double>(flicks_per_second) / static_cast<double>(period);
    // The last activation is the last that starts before the end; the nudge keeps 0.1 s at 1 kHz at 100.
    return static_cast<std::int64_t>(std::ceil(ticks - 1e-6));
}

}  // namespace

void Timeline::begin(compile::Schedule plan) {
    now_ = build::build_generation(std::move(plan), nullptr, context_);
    recorder_.keep_opened();
    add(*now_, 0);
    for (std::size_t g = 0; g < now_->groups.size(); ++g) now_->groups[g]->scheduled.push_back(now_->programs[g].get());
}

/// Gives every group of a generation its program. New groups start at `when`; groups that are gone end there.
void Timeline::add(const build::Generation& next, Flicks when) {
    for (std::size_t g = 0; g < next.groups.size(); ++g) {
        GroupRuntime& group = *next.groups[g];
        build::GroupProgram& program = *next.programs[g];
        program.switch_time = when;
        program.fade_time = program.changes_force ? when - fade_lead(group.plan->period) : when;
        if (next.group_is_new[g]) {
            groups_.push_back(next.groups[g]);
            group.start_at(ceil_div(when, group.plan->period));
            set_end(group);
            group.times_nodes = options_.time_nodes;
            recorder_.attach(group);
        }
    }
    for (const auto& [param, ramp] : next.ramps) ramp->newest_plan = next.number;
    // Where a group of a replayed run ended is in the log.
    for (const auto& group : groups_)
        if (!options_.replay && !next.keeps(group.get()))
            group->end = std::min(group->end.load(), ceil_div(when, group->plan->period));
}

void Timeline::set_end(GroupRuntime& group) const {
    group.end = tick_at(options_.seconds, group.plan->period);
    if (!options_.replay) return;
    const auto index = static_cast<std::size_t>(group.index);
    group.replay({*options_.replay, index}, replayed_changes_);
    group.end = std::min(group.end.load(), options_.replay->end_of(index, group.plan->period));
}

void Timeline::schedule(compile::Schedule plan, Flicks when) {
    std::unique_ptr<build::Generation> next = build_next(std::move(plan));
    recorder_.keep_opened();
    add(*next, when);
    for (std::size_t g = 0; g < next->groups.size(); ++g) next->groups[g]->scheduled.push_back(next->programs[g].get());
    scheduled_.push_back(std::exchange(now_, std::move(next)));
}

std::unique_ptr<build::Generation> Timeline::build_next(compile::Schedule plan) {
    context_.host.begin(plan.patch);
    return build::build_generation(std::move(plan), now_.get(), context_);
}

Flicks Timeline::lead_of(const build::Generation& next) {
    Flicks lead = 0;
    for (std::size_t g = 0; g < next.groups.size(); ++g)
        if (next.programs[g]->changes_force) lead = std::max(lead, fade_lead(next.groups[g]->plan->period));
    return notice_lead + lead;
}

void Timeline::close_gate(build::Generation& next) {
    next.gate = std::make_unique<build::SwitchGate>();
    for (std::size_t g = 0; g < next.groups.size(); ++g) {
        next.programs[g]->gate = next.gate.get();
        const bool has_hands = next.programs[g]->changes_force && !next.group_is_new[g];
        if (has_hands && !next.groups[g]->is_over()) ++next.gate->closed_by;
    }
}

void Timeline::hand_over(std::unique_ptr<build::Generation> next, Flicks when) {
    close_gate(*next);
    add(*next, when);
    for (std::size_t g = 0; g < next->groups.size(); ++g) {
        GroupRuntime& group = *next->groups[g];
        if (next->group_is_new[g]) group.scheduled.push_back(next->programs[g].get());
        else group.hand_over(next->programs[g].get());
    }
    before_ = std::exchange(now_, std::move(next));
}

void Timeline::retire() {
    gather_hashes(*before_, now_.get(), ended_hashes_);
    before_.reset();
    for (const auto& link : now_->links) link->forget_continued();
}

void Timeline::forget_ended() {
    const auto has_ended = [this](const std::shared_ptr<GroupRuntime>& group) {
        // The thread of one that was left behind in a driver still refers to it.
        return group->is_over() && !group->is_forsaken() && !now_->keeps(group.get());
    };
    // From the newest to the oldest, so that the first one of a name stays where it is in the list.
    for (std::size_t i = groups_.size(); i-- > 0;) {
        if (!has_ended(groups_[i])) continue;
        const auto same = std::ranges::find_if(groups_, [&](const auto& other) {
            return other != groups_[i] && has_ended(other) && other->plan->name == groups_[i]->plan->name &&
                   other->plan->period == groups_[i]->plan->period;
        });
        if (same == groups_.end()) continue;
        (*same)->telemetry.merge(groups_[i]->telemetry);
        groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    for (auto ended = std::ranges::count_if(groups_, has_ended); ended > static_cast<std::ptrdiff_t>(max_ended);
         --ended) {
        const auto oldest = std::ranges::find_if(groups_, has_ended);
        const auto next = std::find_if(oldest + 1, groups_.end(), has_ended);
        (*next)->take_over_counts(**oldest);
        groups_.erase(oldest);
    }
}

void Timeline::schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value) {
    const int at = now_->find(node);
    if (at < 0) throw Error(fmt::format("the take sets a parameter of '{}', a node that is not there", node));
    const auto& params = now_->nodes[static_cast<std::size_t>(at)]->params;
    const auto found = params.find(param);
    if (found == params.end()) throw Error(fmt::format("the take sets '{}.{}', which is not there", node, param));
    if (id < 0) throw Error("the take's list of parameter changes is damaged");
    replayed_changes_[id] = {id, 0, found->second, value, now_->ramp_of(found->second)};
}

/// Hashes of the outputs that end with a generation. A group that never took over the next one ends with its own; one
/// that ended before its first tick gave nothing, whether it took its program up or not.
void Timeline::gather_hashes(const build::Generation& old, const build::Generation* next, PortHashes& parts) {
    for (std::size_t g = 0; g < old.groups.size(); ++g) {
        const GroupRuntime& group = *old.groups[g];
        const build::GroupProgram& program = *old.programs[g];
        if (old.number > group.plan_number() || group.ran() == 0) continue;
        const build::GroupProgram* successor = nullptr;
        for (std::size_t n = 0; next && next->number <= group.plan_number() && n < next->groups.size(); ++n)
            if (next->groups[n] == old.groups[g]) successor = next->programs[n].get();
        std::vector<bool> goes_on(program.published.size());
        if (successor)
            for (const build::PublishedOutput& output : successor->published)
                if (output.before >= 0) goes_on[static_cast<std::size_t>(output.before)] = true;
        for (std::size_t k = 0; k < program.published.size(); ++k) {
            const build::PublishedOutput& output = program.published[k];
            if (!goes_on[k]) parts.emplace_back(output.name, output.value(successor ? program.ran : group.ran()));
        }
    }
}

PortHashes Timeline::port_hashes() const {
    PortHashes parts = ended_hashes_;
    for (std::size_t i = 0; i < scheduled_.size(); ++i)
        gather_hashes(*scheduled_[i], i + 1 < scheduled_.size() ? scheduled_[i + 1].get() : now_.get(), parts);
    if (before_) gather_hashes(*before_, now_.get(), parts);
    gather_hashes(*now_, nullptr, parts);
    // An output that ended and came back has several parts, in the order of the edits.
    std::ranges::stable_sort(parts, {}, [](const auto& part) { return part.first; });
    PortHashes ports;
    for (std::size_t i = 0; i < parts.size();) {
        std::size_t end = i + 1;
        while (end < parts.size() && parts[end].first == parts[i].first) ++end;
        Hash all;
        for (std::size_t k = i; k < end; ++k) all.add_word(parts[k].second);
        ports.emplace_back(parts[i].first, end == i + 1 ? parts[i].second : all.value());
        i = end;
    }
    return ports;
}

double Timeline::progress_seconds() const {
    double least = options_.seconds;
    for (const auto& group : now_->groups) least = std::min(least, seconds(group->done() * group->plan->period));
    return least;
}

Report Timeline::report() const {
    Report report;
    std::vector<const build::LiveNode*> nodes;
    for (const auto& node : now_->nodes) nodes.push_back(node.get());
    std::ranges::sort(nodes, {}, &build::LiveNode::name);
    for (const build::LiveNode* node : nodes) node->type->report(node->instance.get(), report);
    return report;
}

}  // namespace tactus::run

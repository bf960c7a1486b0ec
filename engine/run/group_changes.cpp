// SPDX-License-Identifier: Apache-2.0
// What a rate group takes up before a call: parameters, a pause, another program.
#include "dsp/core/realtime.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/group_runtime.hpp"

#include <cstring>

namespace tactus::run {

void GroupRuntime::apply_parameters() noexcept {
    if (replayed) {
        for (std::size_t i = cursor_; i < replayed->size() && (*replayed)[i].tick <= next_; ++i) {
            const take::TimingRecord& record = (*replayed)[i];
            if (record.kind != take::TimingKind::parameter || record.tick != next_) continue;
            const ParameterChange& change = (*replayed_changes)[static_cast<std::size_t>(record.value)];
            change.param->value = change.value;
        }
        return;
    }
    while (has_change_ || (has_change_ = changes_.pop(change_))) {
        if (change_.when > next_ * plan->period) return;
        change_.param->value = change_.value;
        note(take::TimingKind::parameter, 0, 0, change_.id, nullptr);
        has_change_ = false;
    }
}

void GroupRuntime::hold_off() noexcept {
    for (build::DeviceSlot* slot : program_->driven) slot->port.hold_off = fades_for_plan_ || is_paused_;
}

void GroupRuntime::apply_pause(Pace pace) noexcept {
    bool wanted = is_paused_;
    if (replayed) {
        if (const take::TimingRecord* logged = replayed_at(take::TimingKind::fade, 1, next_))
            wanted = logged->value != 0;
    } else if (pause) {
        wanted = pause->holds_off(next_ * plan->period);
    }
    if (wanted == is_paused_) return;
    is_paused_ = wanted;
    hold_off();
    if (pace == Pace::live) note(take::TimingKind::fade, 1, 0, wanted ? 1 : 0, nullptr);
}

void GroupRuntime::rest() noexcept {
    if (!program_) return;  // made by an edit while the run stands
    for (build::DeviceSlot* slot : program_->driven) slot->guard.commit(*slot->device, {}, steady_ns());
}

void GroupRuntime::take_over(build::GroupProgram& next) noexcept {
    if (program_) {
        fades_for_plan_ = false;
        hold_off();
        program_->ran = ran_;
        for (build::PublishedOutput& output : next.published) {
            if (output.before < 0) continue;
            const build::PublishedOutput& old = program_->published[static_cast<std::size_t>(output.before)];
            output.hash = old.hash;
            output.samples = old.samples;
        }
    }
    for (const build::MovedOutput& output : next.moved) {
        std::memcpy(output.to, output.port->data, output.bytes);
        output.port->data = output.to;
    }
    for (const auto& [input, wired] : next.wiring) *input = *wired;
    for (const auto& [param, value] : next.params) param->value = value;
    for (const auto& delay : next.delays)
        if (delay->before) delay->history.swap(delay->before->history);
    for (Link* link : next.ended) link->abandon();
    for (Link* link : next.new_inputs) link->take_over();
    for (Link* link : next.new_outputs) link->begin_at(next_);
    program_ = &next;
    if (is_paused_) hold_off();
    generation_.store(next.generation, std::memory_order_release);
}

bool GroupRuntime::take_changes(Pace pace) noexcept {
    const RealtimeScope scope;
    bool took_over = false;
    for (;;) {
        if (finished()) return took_over;
        if (!upcoming_ && taken_ < scheduled.size()) upcoming_ = scheduled[taken_++];
        if (!upcoming_) programs_.pop(upcoming_);
        if (program_) {
            apply_parameters();
            apply_pause(pace);
        }
        if (!upcoming_ || !switch_if_due(pace)) return took_over;
        took_over = true;
    }
}

bool GroupRuntime::switch_if_due(Pace pace) noexcept {
    const Flicks time = next_ * plan->period;
    // The first program of a group is not in the log.
    const bool is_logged = replayed && program_;
    const take::TimingRecord* logged = is_logged ? replayed_at(take::TimingKind::plan, 0, next_) : nullptr;
    const bool must_switch =
        is_logged ? logged && logged->value == upcoming_->generation : time >= upcoming_->switch_time;
    if (must_switch) {
        if (pace == Pace::live && program_) note(take::TimingKind::plan, 0, 0, upcoming_->generation, nullptr);
        take_over(*upcoming_);
        upcoming_ = nullptr;
        return true;
    }
    const bool must_fade = is_logged ? replayed_at(take::TimingKind::fade, 0, next_) != nullptr
                                     : program_ && !fades_for_plan_ && time >= upcoming_->fade_time &&
                                           upcoming_->fade_time < upcoming_->switch_time;
    if (must_fade) {
        fades_for_plan_ = true;
        hold_off();
        if (pace == Pace::live) note(take::TimingKind::fade, 0, 0, 0, nullptr);
    }
    return false;
}

}  // namespace tactus::run

// SPDX-License-Identifier: Apache-2.0
// What a rate group takes up before a call: parameters, a pause, another program.
#include "dsp/core/realtime.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/group_runtime.hpp"

#include <cstring>

namespace tactus::run {

void GroupRuntime::hold_off() noexcept {
    for (build::DeviceSlot* slot : program_->driven) slot->port.hold_off = fades_for_plan_ || is_paused_;
}

void GroupRuntime::apply_pause() noexcept {
    const bool wanted = decisions_->holds_off(next_, is_paused_);
    if (wanted == is_paused_) return;
    is_paused_ = wanted;
    hold_off();
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
    plan_number_.store(next.plan_number, std::memory_order_release);
}

bool GroupRuntime::take_changes() noexcept {
    const RealtimeScope scope;
    bool took_over = false;
    for (;;) {
        if (finished()) return took_over;
        if (!upcoming_ && taken_ < scheduled.size()) upcoming_ = scheduled[taken_++];
        if (!upcoming_) programs_.pop(upcoming_);
        if (program_) {
            decisions_->apply_parameters(next_);
            apply_pause();
        }
        if (!upcoming_ || !switch_if_due()) return took_over;
        took_over = true;
    }
}

bool GroupRuntime::switch_if_due() noexcept {
    // A group begins with its first program at the time that the plan says; only later ones are decided.
    const bool must_switch =
        program_ ? decisions_->switches_to(*upcoming_, next_) : next_ * plan->period >= upcoming_->switch_time;
    if (must_switch) {
        take_over(*upcoming_);
        upcoming_ = nullptr;
        return true;
    }
    if (program_ && !fades_for_plan_ && decisions_->fades_for(*upcoming_, next_)) {
        fades_for_plan_ = true;
        hold_off();
    }
    return false;
}

}  // namespace tactus::run

// SPDX-License-Identifier: Apache-2.0
// What a rate group takes up before a call: parameters, a pause, another program.
#include "dsp/core/clock.hpp"
#include "dsp/core/realtime.hpp"
#include "engine/run/group_runtime.hpp"

#include <algorithm>
#include <cstring>

namespace tactus::run {

void GroupRuntime::apply_pause() noexcept {
    const bool wanted = decisions_->holds_off(next_, is_paused_);
    if (wanted == is_paused_) return;
    is_paused_ = wanted;
    // The hand may have moved meanwhile: what was computed before the pause is not what it presses against.
    for (std::size_t i = 0; !is_paused_ && i < program_->driven.size(); ++i)
        program_->driven[i]->settled = next_ * plan->period + program_->warm_ups[i];
}

void GroupRuntime::rest() noexcept {
    if (!program_) return;  // made by an edit while the run stands
    for (io::DeviceSlot* slot : program_->driven) decisions_->let_rest(*slot);
}

void GroupRuntime::take_over(build::GroupProgram& next) noexcept {
    const std::int64_t ramp_length = program_ ? decisions_->ramp_length(next_) : 0;
    if (program_) {
        fades_for_plan_ = has_let_go_ = false;
        program_->ran = ran_;
        for (io::DeviceSlot* slot : program_->driven) slot->guard.set_driven(false);
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
    ramps_.keep(next.plan_number);
    for (const build::NewLimit& limit : next.limits)
        ramps_.limit(*limit.param, limit.ramp, limit.most, next_, ramp_length, next.plan_number);
    for (const build::NewValue& changed : next.params)
        ramps_.set(*changed.param, changed.ramp, changed.value, next_, ramp_length, next.plan_number);
    for (const auto& delay : next.delays)
        if (delay->before) delay->history.swap(delay->before->history);
    for (Link* link : next.ended) link->abandon();
    for (Link* link : next.new_inputs) link->take_over();
    for (Link* link : next.new_outputs) link->begin_at(next_);
    for (std::size_t i = 0; i < next.driven.size(); ++i) {
        io::DeviceSlot* const slot = next.driven[i];
        slot->guard.set_driven(true);
        slot->overdue = -1;  // of the sources of the program before
        if (next.is_new_path[i]) slot->settled = next_ * plan->period + next.warm_ups[i];
    }
    program_ = &next;
    plan_number_.store(next.plan_number, std::memory_order_release);
}

bool GroupRuntime::take_changes() noexcept {
    const RealtimeScope scope;
    rests_.fetch_add(1, std::memory_order_release);
    bool took_over = false;
    for (;;) {
        if (finished() && !decisions_->is_replayed()) return took_over;
        if (!upcoming_ && taken_ < scheduled.size()) upcoming_ = scheduled[taken_++];
        if (!upcoming_) programs_.pop(upcoming_);
        if (program_) {
            decisions_->apply_parameters(next_, plan_number(), ramps_);
            apply_pause();
        }
        if (!upcoming_ || !switch_if_due()) return took_over;
        took_over = true;
    }
}

void GroupRuntime::take_program_ahead() noexcept {
    const RealtimeScope scope;
    rests_.fetch_add(1, std::memory_order_release);
    if (!program_) return;
    do {
        if (!upcoming_) programs_.pop(upcoming_);
        // Changes that were made before the plan are applied before it.
        if (!upcoming_ || decisions_->has_changes()) return;
        if (!program_->devices.empty() || !upcoming_->devices.empty()) return;
    } while (switch_if_due());
}

bool GroupRuntime::is_let_go() noexcept {
    build::SwitchGate* const gate = upcoming_->gate;
    if (!gate) return true;
    if (fades_for_plan_ && !has_let_go_ && upcoming_->changes_force) {
        // At least one tick has run since the fade began, which is long enough for a force of zero to stay so.
        has_let_go_ = std::ranges::all_of(program_->driven, [](const io::DeviceSlot* slot) {
            return slot->port.wrench.force == Vec3(0.0) && slot->port.wrench.torque == Vec3(0.0);
        });
        if (has_let_go_) gate->closed_by.fetch_sub(1, std::memory_order_acq_rel);
    }
    return gate->closed_by.load(std::memory_order_acquire) == 0;
}

bool GroupRuntime::switch_if_due() noexcept {
    // The first program starts at the time in the schedule; later switches are decisions (decisions.hpp).
    const bool must_switch = program_ ? is_let_go() && decisions_->switches_to(*upcoming_, next_)
                                      : next_ * plan->period >= upcoming_->switch_time;
    if (must_switch) {
        take_over(*upcoming_);
        upcoming_ = nullptr;
        return true;
    }
    if (program_ && !fades_for_plan_ && decisions_->fades_for(*upcoming_, next_)) fades_for_plan_ = true;
    return false;
}

}  // namespace tactus::run

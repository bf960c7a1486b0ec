// SPDX-License-Identifier: Apache-2.0
#include "engine/run/clock_decisions.hpp"

#include "dsp/core/clock.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/run/link.hpp"

#include <algorithm>

namespace tactus::run {

void ClockDecisions::apply_parameters(std::int64_t tick, std::int64_t plan, ParamRamps& ramps) noexcept {
    while (has_changes()) {
        if (change_.when > tick * period_) return;
        const std::int64_t length = change_.ramp ? ParamRamps::length(period_) : 0;
        ramps.set(*change_.param, change_.ramp, change_.value, tick, length, plan);
        log_.note(take::TimingKind::parameter, tick, {.source = static_cast<int>(length), .value = change_.id});
        has_change_ = false;
        changes_.applied.fetch_add(1, std::memory_order_release);
    }
}

bool ClockDecisions::has_changes() noexcept { return has_change_ || (has_change_ = changes_.ring.pop(change_)); }

std::int64_t ClockDecisions::ramp_length(std::int64_t) const noexcept { return ParamRamps::length(period_); }

bool ClockDecisions::switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept {
    return tick * period_ >= next.switch_time;
}

bool ClockDecisions::fades_for(const build::GroupProgram& next, std::int64_t tick) noexcept {
    return tick * period_ >= next.fade_time && next.fade_time < next.switch_time;
}

std::int64_t ClockDecisions::end_of_call(std::int64_t tick, std::int64_t until,
                                         const build::GroupProgram* next) const noexcept {
    const auto cut_at = [&](Flicks time) {
        if (const std::int64_t at = ceil_div(time, period_); at > tick) until = std::min(until, at);
    };
    if (next) {
        cut_at(next->fade_time);
        cut_at(next->switch_time);
    }
    if (has_change_) cut_at(change_.when);
    return until;
}

bool OfflineDecisions::holds_off(std::int64_t tick, bool before) noexcept {
    return pause_ ? pause_->holds_off(tick * period_, period_) : before;
}

LinkReading OfflineDecisions::read(const Link& link, const GroupRuntime& producer, std::int64_t tick, int) noexcept {
    const std::int64_t index = newest(link, producer, tick);
    return {index, is_late(link, index, producer.end.load(std::memory_order_relaxed) - 1, tick)};
}

void OfflineDecisions::commit(io::DeviceSlot& slot) noexcept {
    slot.device->commit(slot.port.wrench);
    if (slot.port.info.fingers > 0) slot.device->drive(slot.port.motors);
}

bool LiveDecisions::holds_off(std::int64_t tick, bool before) noexcept {
    const bool now = pause_.holds_off(tick * period_, period_);
    if (now != before) log_.note(take::TimingKind::fade, tick, {.source = 1, .value = now ? 1 : 0});
    return now;
}

bool LiveDecisions::switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept {
    const bool now = ClockDecisions::switches_to(next, tick);
    if (now)
        log_.note(take::TimingKind::plan, tick,
                  {.source = static_cast<int>(ParamRamps::length(period_)), .value = next.plan_number});
    return now;
}

bool LiveDecisions::fades_for(const build::GroupProgram& next, std::int64_t tick) noexcept {
    const bool now = ClockDecisions::fades_for(next, tick);
    if (now) log_.note(take::TimingKind::fade, tick, {});
    return now;
}

std::int64_t LiveDecisions::readable_until(const Link& link, const GroupRuntime&, std::int64_t tick,
                                           std::int64_t until) const noexcept {
    return std::min(until, std::max(tick + link.longest_call(), link.window_end(tick)));
}

bool LiveDecisions::has_room(const std::vector<Link*>&, std::int64_t, int) const noexcept { return true; }

int LiveDecisions::overdue(const io::DeviceSlot& slot, const std::vector<build::ValueSource>& sources,
                           std::int64_t tick) noexcept {
    const auto is_overdue = [now = tick * period_](const build::ValueSource& source) {
        if (source.link) return source.link->is_unusable(source.wires);
        const GroupRuntime& group = *source.group;
        return !group.is_over() && now >= group.computed() * group.plan->period + source.latency + source.limit;
    };
    const auto found = std::ranges::find_if(sources, is_overdue);
    const int now = found == sources.end() ? -1 : static_cast<int>(found - sources.begin());
    if (now != slot.overdue) log_.note(take::TimingKind::overdue, tick, {.source = slot.id, .value = now});
    return now;
}

LinkReading LiveDecisions::read(const Link& link, const GroupRuntime& producer, std::int64_t tick,
                                int frames) noexcept {
    const std::int64_t index = newest(link, producer, tick);
    // The end of the producer can still move; its last activation is only known once it has ended.
    const std::int64_t last = producer.is_over() ? producer.done() - 1 : Link::unknown;
    const bool late = is_late(link, index, last, tick);
    if (late) log_.note(take::TimingKind::held_read, tick, {link.id, frames, index});
    return {index, late};
}

bool LiveDecisions::drops(const Link& link, std::int64_t tick, int frames) noexcept {
    const bool drop = !link.has_room(tick, frames);
    if (drop) log_.note(take::TimingKind::dropped, tick, {link.id, frames});
    return drop;
}

void LiveDecisions::commit(io::DeviceSlot& slot) noexcept {
    if (!driver.enter()) return;
    slot.guard.commit(*slot.device, slot.port.wrench, steady_ns());
    if (slot.port.info.fingers > 0) slot.device->drive(slot.port.motors);
    driver.leave();
}

}  // namespace tactus::run

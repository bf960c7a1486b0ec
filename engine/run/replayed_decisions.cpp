// SPDX-License-Identifier: Apache-2.0
#include "engine/run/replayed_decisions.hpp"

#include "engine/run/group_runtime.hpp"
#include "engine/run/link.hpp"
#include "engine/take/sound_record.hpp"

#include <algorithm>

namespace tactus::run {

using take::TimingKind;
using take::TimingRecord;

static constexpr int any_source = -1;

const TimingRecord* ReplayedDecisions::find(TimingKind kind, int source, std::int64_t tick) const noexcept {
    for (std::size_t i = first_; const TimingRecord* at = records_.at(i); ++i) {
        const TimingRecord& record = *at;
        if (record.tick > tick) break;
        const bool covers = tick < record.tick + std::max(record.count, 1);
        const bool is_meant = source == any_source || record.source == static_cast<std::uint32_t>(source);
        if (covers && record.kind == kind && is_meant) return &record;
    }
    return nullptr;
}

const TimingRecord* ReplayedDecisions::find_switch(std::int64_t plan, std::int64_t tick) const noexcept {
    // Several plans may take over between two activations.
    for (std::size_t i = first_; const TimingRecord* r = records_.at(i); ++i) {
        if (r->tick > tick) break;
        if (r->kind == TimingKind::plan && r->tick == tick && r->value == plan) return r;
    }
    return nullptr;
}

std::int64_t ReplayedDecisions::skip_from(std::int64_t tick) const noexcept {
    const TimingRecord* skip = find(TimingKind::skipped, 0, tick);
    if (!skip) return tick;
    // A schedule may have taken over before the activation was skipped.
    for (std::size_t i = first_; const TimingRecord* r = records_.at(i); ++i) {
        if (r == skip) break;
        if (r->kind == TimingKind::plan && r->tick == tick && r->value > switched_to_) return tick;
    }
    return skip->tick + skip->count;
}

void ReplayedDecisions::apply_parameters(std::int64_t tick, std::int64_t plan, ParamRamps& ramps) noexcept {
    // Each once, and those that came after a switch in the same activation after it.
    for (; const TimingRecord* at = records_.at(applied_); ++applied_) {
        const TimingRecord& record = *at;
        if (record.tick > tick) return;
        if (record.kind == TimingKind::plan && record.tick == tick && record.value > plan) return;
        if (record.kind != TimingKind::parameter || record.tick != tick) continue;
        const auto change = changes_.find(record.value);
        if (change == changes_.end()) continue;  // a log without the take that lists it
        ramps.set(*change->second.param, change->second.ramp, change->second.value, tick, record.source, plan);
    }
}

bool ReplayedDecisions::holds_off(std::int64_t tick, bool before) noexcept {
    const TimingRecord* pause = find(TimingKind::fade, 1, tick);
    return pause ? pause->value != 0 : before;
}

bool ReplayedDecisions::switches_to(const build::GroupProgram& next, std::int64_t tick) noexcept {
    if (!find_switch(next.plan_number, tick)) return false;
    switched_to_ = next.plan_number;
    return true;
}

std::int64_t ReplayedDecisions::ramp_length(std::int64_t tick) const noexcept {
    const TimingRecord* plan = find(TimingKind::plan, any_source, tick);
    return plan ? plan->source : 0;
}

bool ReplayedDecisions::fades_for(const build::GroupProgram&, std::int64_t tick) noexcept {
    return find(TimingKind::fade, 0, tick) != nullptr;
}

std::int64_t ReplayedDecisions::end_of_call(std::int64_t tick, std::int64_t until,
                                            const build::GroupProgram*) const noexcept {
    // A logged decision begins or ends only between calls.
    for (std::size_t i = first_; const TimingRecord* r = records_.at(i); ++i) {
        const TimingRecord& record = *r;
        if (record.tick >= until) break;
        if (record.kind == TimingKind::heard) continue;
        const std::int64_t at = record.tick > tick ? record.tick : record.tick + record.count;
        if (at > tick) until = std::min(until, at);
    }
    return until;
}

std::int64_t ReplayedDecisions::awaited(const Link& link, std::int64_t tick) const noexcept {
    const TimingRecord* held = find(TimingKind::held_read, link.id, tick);
    return held ? held->value : link.wanted(tick);
}

bool ReplayedDecisions::has_room(const std::vector<Link*>& links, std::int64_t tick, int frames) const noexcept {
    return std::ranges::all_of(links, [&](const Link* link) {
        return link->has_room(tick, frames) || find(TimingKind::dropped, link->id, tick);
    });
}

bool ReplayedDecisions::may_begin(const std::vector<Link*>&, std::int64_t) const noexcept {
    // A live run checks for space when a call ends; reads in the meantime have made room.
    return true;
}

void ReplayedDecisions::acquire(io::DeviceSlot& slot, std::int64_t tick, Flicks elapsed) noexcept {
    if (const TimingRecord* logged = find(TimingKind::device_sample, slot.id, tick)) slot.port.sample = logged->sample;
    else sample(slot, elapsed);
    log_.note(TimingKind::device_sample, tick, {slot.id, 1, 0, &slot.port.sample});
}

int ReplayedDecisions::overdue(const io::DeviceSlot& slot, const std::vector<build::ValueSource>& sources,
                               std::int64_t tick) noexcept {
    const TimingRecord* const record = find(TimingKind::overdue, slot.id, tick);
    const std::int64_t now = record ? record->value : slot.overdue;
    return now < static_cast<std::int64_t>(sources.size()) ? static_cast<int>(now) : -1;
}

void ReplayedDecisions::hear(io::SoundHeard& heard, std::int64_t tick, int frames, std::int64_t due_ns) noexcept {
    heard.fill(tick, frames, due_ns);
    for (std::int64_t at = tick; at < tick + frames; ++at) {
        // The first that reaches so far: each one reaches further than the one before.
        const TimingRecord* const record = find(TimingKind::heard, heard.id, at);
        if (!record || record->count == 0) continue;
        const std::int64_t end = record->tick + record->count, first = end - record->value;
        const auto samples = take::unpack_sound(record->sample);
        for (; at < std::min(end, tick + frames); ++at)
            if (const std::int64_t i = at - first; i >= 0 && i < take::sound_record_samples)
                heard.port.samples[static_cast<std::size_t>(at - tick)] = samples[static_cast<std::size_t>(i)];
        --at;
    }
    note_heard(heard, tick, frames);
}

LinkReading ReplayedDecisions::read(const Link& link, const GroupRuntime& producer, std::int64_t tick, int) noexcept {
    const TimingRecord* held = find(TimingKind::held_read, link.id, tick);
    const std::int64_t index = held ? held->value : newest(link, producer, tick);
    return {index, is_late(link, index, producer.end.load(std::memory_order_relaxed) - 1, tick)};
}

bool ReplayedDecisions::drops(const Link& link, std::int64_t tick, int) noexcept {
    return find(TimingKind::dropped, link.id, tick) != nullptr;
}

void ReplayedDecisions::commit(io::DeviceSlot&) noexcept {}

void ReplayedDecisions::pass(std::int64_t tick) noexcept {
    for (const TimingRecord* r = records_.at(first_); r && r->tick + std::max(r->count, 1) <= tick;)
        r = records_.at(++first_);
    records_.forget_before(std::min(first_, applied_));
    records_.read_ahead(tick + read_ahead);
}

}  // namespace tactus::run

// SPDX-License-Identifier: Apache-2.0
#include "engine/run/group_runtime.hpp"

#include "dsp/core/realtime.hpp"
#include "engine/run/clock.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace tactus::run {

const take::TimingRecord* GroupRuntime::replayed_at(take::TimingKind kind, std::uint32_t source,
                                                    std::int64_t tick) const noexcept {
    if (!replayed) return nullptr;
    for (std::size_t i = cursor_; i < replayed->size(); ++i) {
        const take::TimingRecord& record = (*replayed)[i];
        if (record.tick > tick) break;
        const bool covers = tick < record.tick + std::max(record.count, 1);
        if (covers && record.kind == kind && record.source == source) return &record;
    }
    return nullptr;
}

int GroupRuntime::cut(int frames) const noexcept {
    std::int64_t until =
        std::min<std::int64_t>(next_ + std::min(frames, max_frames), end.load(std::memory_order_relaxed));
    const auto cut_at = [&](std::int64_t tick) {
        if (tick > next_) until = std::min(until, tick);
    };
    for (const Link* link : program_->inputs) cut_at(link->window_end(next_));
    for (const auto& delay : program_->delays) cut_at(next_ + delay->count);
    if (!replayed) {
        if (upcoming_) {
            cut_at(ceil_div(upcoming_->fade_time, plan->period));
            cut_at(ceil_div(upcoming_->switch_time, plan->period));
        }
        if (has_change_) cut_at(ceil_div(change_.when, plan->period));
    } else {
        // A logged decision begins or ends only between calls.
        for (std::size_t i = cursor_; i < replayed->size(); ++i) {
            const take::TimingRecord& record = (*replayed)[i];
            if (record.tick >= until) break;
            cut_at(record.tick > next_ ? record.tick : record.tick + record.count);
        }
    }
    return static_cast<int>(std::max<std::int64_t>(until - next_, 1));
}

bool GroupRuntime::ready() const noexcept {
    if (begun_ > 0) return has_room(begun_);
    for (std::size_t i = 0; i < program_->inputs.size(); ++i) {
        const Link& link = *program_->inputs[i];
        std::int64_t wanted = link.wanted(next_);
        if (const take::TimingRecord* held =
                replayed_at(take::TimingKind::held_read, static_cast<std::uint32_t>(link.id), next_))
            wanted = held->value;
        const GroupRuntime& producer = *program_->producers[i];
        wanted = std::min(wanted, producer.end.load(std::memory_order_relaxed) - 1);
        if (wanted >= 0 && producer.done() <= wanted) return false;
    }
    // Live, room is asked for when a call ends, and what others read meanwhile has made some.
    return replayed || has_room(1);
}

bool GroupRuntime::has_room(int frames) const noexcept {
    return std::ranges::all_of(program_->outputs, [&](const Link* link) {
        return link->has_room(next_, frames) ||
               replayed_at(take::TimingKind::dropped, static_cast<std::uint32_t>(link->id), next_);
    });
}

void GroupRuntime::note(take::TimingKind kind, int source, std::int64_t count, std::int64_t value,
                        const DeviceSample* sample) noexcept {
    if (!log) return;
    take::TimingRecord record;
    record.kind = kind;
    record.group = static_cast<std::uint16_t>(index);
    record.source = static_cast<std::uint32_t>(source);
    record.count = static_cast<std::int32_t>(count);
    record.tick = next_;
    record.value = value;
    if (sample) record.sample = *sample;
    if (!log->push(record)) log_overflow.store(true, std::memory_order_relaxed);
}

void GroupRuntime::acquire() noexcept {
    const Flicks elapsed = last_ < 0 ? 0 : (next_ - last_) * plan->period;
    for (build::DeviceSlot* slot : program_->devices) {
        const take::TimingRecord* logged =
            replayed_at(take::TimingKind::device_sample, static_cast<std::uint32_t>(slot->id), next_);
        slot->port.sample = logged ? logged->sample : slot->device->acquire(seconds(elapsed));
        if (!logged) {
            slot->port.sample.taken = slot->guard.was_taken();
            slot->port.sample.sound_lost = slot->guard.is_asked_to_fade();
        }
        note(take::TimingKind::device_sample, slot->id, 1, 0, &slot->port.sample);
    }
}

void GroupRuntime::read_links(int frames, Pace pace) noexcept {
    bool missed = false;
    for (std::size_t i = 0; i < program_->inputs.size(); ++i) {
        Link& link = *program_->inputs[i];
        const GroupRuntime& producer = *program_->producers[i];
        const std::int64_t want = link.wanted(next_);
        std::int64_t chosen = link.used();
        if (const take::TimingRecord* held =
                replayed_at(take::TimingKind::held_read, static_cast<std::uint32_t>(link.id), next_))
            chosen = held->value;
        else if (want > chosen) chosen = link.newest_available(want, producer.done());
        // Past the producer's last activation there is nothing to miss. Live, its end may still be set behind where it
        // is by then: only when it is over is it known which was the last.
        std::int64_t last = producer.end.load(std::memory_order_relaxed) - 1;
        if (pace == Pace::live) last = producer.is_over() ? producer.done() - 1 : Link::unknown;
        if (chosen < std::min(want, last) && link.misses(want)) {
            missed = true;
            producer.telemetry.awaited.fetch_add(1, std::memory_order_relaxed);
            if (pace == Pace::live) note(take::TimingKind::held_read, link.id, frames, chosen, nullptr);
        }
        link.read(chosen);
        link.deliver(next_, frames);
    }
    if (missed) telemetry.misses.fetch_add(1, std::memory_order_relaxed);
}

void GroupRuntime::publish(int frames, Pace pace) noexcept {
    std::size_t took = 0;
    for (Link* link : program_->outputs) {
        const auto id = static_cast<std::uint32_t>(link->id);
        const bool drop = pace == Pace::live ? !link->has_room(next_, frames)
                                             : replayed_at(take::TimingKind::dropped, id, next_) != nullptr;
        if (drop) {
            telemetry.dropped.fetch_add(frames, std::memory_order_relaxed);
            if (pace == Pace::live) note(take::TimingKind::dropped, link->id, frames, 0, nullptr);
            continue;
        }
        link->publish(next_, frames);
        ++took;
    }
    for (SnapshotOutput* output : program_->snapshots)
        output->last_was_dropped = took == 0 && !program_->outputs.empty();
}

int GroupRuntime::call(int frames, Pace pace) noexcept {
    begin_call(frames, pace);
    return finish_call(pace);
}

void GroupRuntime::begin_call(int frames, Pace pace) noexcept {
    int n = cut(plan->has_audio ? frames : 1);
    // Who asked for room for more than one could wait for ever, for a reader that waits for the first of them.
    while (pace == Pace::offline && n > 1 && !has_room(n)) n /= 2;
    begun_ = n;
    now = next_ * plan->period;
    acquire();
    RealtimeScope scope;
    read_links(n, pace);
    for (SnapshotOutput* output : program_->snapshots) {
        output->oldest_readable = std::numeric_limits<std::int64_t>::max();
        for (const Link* link : program_->outputs)
            output->oldest_readable = std::min(output->oldest_readable, link->oldest_version(output));
    }
    for (const auto& delay : program_->delays) delay->recall(next_, n);
    run_steps(n);
    for (const auto& delay : program_->delays) delay->remember(next_, n);
}

int GroupRuntime::finish_call(Pace pace) noexcept {
    const int n = std::exchange(begun_, 0);
    {
        RealtimeScope scope;
        publish(n, pace);
    }
    for (build::DeviceSlot* slot : program_->driven) {
        telemetry.force_N.store(glm::length(slot->port.wrench.force), std::memory_order_relaxed);
        slot->guard.note(slot->port.fault, next_, glm::length(slot->committed.force));
        slot->committed = slot->port.wrench;
        if (pace == Pace::live) slot->guard.commit(*slot->device, slot->port.wrench, steady_ns());
        else if (!replayed) slot->device->commit(io::clamp_to_device(slot->port.wrench, slot->port.info));
        if (!replayed && slot->port.info.fingers > 0) slot->device->drive(slot->port.motors);
    }
    telemetry.ticks.fetch_add(n, std::memory_order_relaxed);
    last_ = next_ + n - 1;
    next_ += n;
    while (replayed && cursor_ < replayed->size() &&
           (*replayed)[cursor_].tick + std::max((*replayed)[cursor_].count, 1) <= next_)
        ++cursor_;
    done_.store(next_, std::memory_order_release);
    return n;
}

void GroupRuntime::skip_to(std::int64_t to) noexcept {
    telemetry.skipped.fetch_add(to - next_, std::memory_order_relaxed);
    note(take::TimingKind::skipped, 0, to - next_, 0, nullptr);
    next_ = to;
    done_.store(next_, std::memory_order_release);
}

bool GroupRuntime::replay_skip() noexcept {
    const take::TimingRecord* record = replayed_at(take::TimingKind::skipped, 0, next_);
    if (!record) return false;
    telemetry.skipped.fetch_add(record->count, std::memory_order_relaxed);
    next_ = record->tick + record->count;
    done_.store(next_, std::memory_order_release);
    return true;
}

void GroupRuntime::end_at(std::int64_t tick) noexcept {
    end.store(std::min(end.load(), tick));
    note(take::TimingKind::end, 0, 0, 0, nullptr);
    if (program_)
        for (build::DeviceSlot* slot : program_->devices) slot->guard.retire();
    // From here on nothing of the group is touched by its thread.
    over_.store(true, std::memory_order_release);
}

}  // namespace tactus::run

// SPDX-License-Identifier: Apache-2.0
#include "engine/run/group_runtime.hpp"

#include "dsp/core/realtime.hpp"
#include "engine/run/clock_decisions.hpp"
#include "engine/run/replayed_decisions.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

namespace tactus::run {

GroupRuntime::GroupRuntime(const compile::ScheduleGroup& description, int number, int frames)
    : plan(&description_),
      index(number),
      max_frames(frames),
      log(number),
      description_(description),
      ramps_(description.period),
      decisions_(std::make_unique<OfflineDecisions>(log, description.period, changes_)) {}

GroupRuntime::~GroupRuntime() = default;

void GroupRuntime::decide_live(const PauseWindow& pause) {
    decisions_ = std::make_unique<LiveDecisions>(log, plan->period, changes_, pause);
}

void GroupRuntime::decide_advanced(const PauseWindow& pause) {
    decisions_ = std::make_unique<OfflineDecisions>(log, plan->period, changes_, &pause);
}

void GroupRuntime::replay(take::GroupRecords records, const ReplayedChanges& changes) {
    decisions_ = std::make_unique<ReplayedDecisions>(log, std::move(records), changes);
}

int GroupRuntime::cut(int frames) const noexcept {
    std::int64_t until =
        std::min<std::int64_t>(next_ + std::min(frames, max_frames), end.load(std::memory_order_relaxed));
    const auto cut_at = [&](std::int64_t tick) {
        if (tick > next_) until = std::min(until, tick);
    };
    // Calls of two groups with calls of one length begin together, after skipped activations, too.
    cut_at(ceil_div(next_ + 1, max_frames) * max_frames);
    for (const Link* link : program_->inputs)
        if (!link->changes_within_calls) cut_at(link->window_end(next_));
    until = decisions_->end_of_call(next_, ramps_.next_change(next_, until), upcoming_);
    for (std::size_t i = 0; i < program_->inputs.size(); ++i)
        if (const Link& link = *program_->inputs[i]; link.changes_within_calls)
            until = decisions_->readable_until(link, *program_->producers[i], next_, until);
    return static_cast<int>(std::max<std::int64_t>(until - next_, 1));
}

bool GroupRuntime::ready() const noexcept {
    if (begun_ > 0) return decisions_->has_room(program_->outputs, next_, begun_);
    for (std::size_t i = 0; i < program_->inputs.size(); ++i) {
        const GroupRuntime& producer = *program_->producers[i];
        const std::int64_t wanted = std::min(decisions_->awaited(*program_->inputs[i], next_),
                                             producer.end.load(std::memory_order_relaxed) - 1);
        if (wanted >= 0 && producer.done() <= wanted) return false;
    }
    return decisions_->may_begin(program_->outputs, next_);
}

void GroupRuntime::acquire(int frames) noexcept {
    for (io::SoundHeard* heard : program_->heard) decisions_->hear(*heard, next_, frames, due_ns);
    const Flicks elapsed = last_ < 0 ? 0 : (next_ - last_) * plan->period;
    for (io::DeviceSlot* slot : program_->devices) decisions_->acquire(*slot, next_, elapsed);
}

void GroupRuntime::check_sources() noexcept {
    for (std::size_t i = 0; i < program_->driven.size(); ++i) {
        io::DeviceSlot& slot = *program_->driven[i];
        slot.port.hold_off = fades_for_plan_ || is_paused_ || now < slot.settled;
        const std::vector<build::ValueSource>& sources = program_->sources[i];
        slot.overdue = decisions_->overdue(slot, sources, next_);
        slot.port.overdue =
            slot.overdue < 0 ? control::Fault::none : sources[static_cast<std::size_t>(slot.overdue)].fault;
    }
}

bool GroupRuntime::read_link(Link& link, const GroupRuntime& producer, int frames) noexcept {
    if (!link.changes_within_calls) {
        const LinkReading reading = decisions_->read(link, producer, next_, frames);
        link.read(reading.index);
        link.deliver(next_, frames);
        return reading.is_late;
    }
    for (int from = 0; from < frames;) {
        const std::int64_t tick = next_ + from;
        const LinkReading reading = decisions_->read(link, producer, tick, frames - from);
        // Data that are late for one part of a call are not polled again for the next part.
        const auto part =
            reading.is_late ? frames - from : std::min<std::int64_t>(frames - from, link.window_end(tick) - tick);
        link.deliver_part(reading.index, tick, from, static_cast<int>(part));
        if (reading.is_late) return true;
        from += static_cast<int>(part);
    }
    return false;
}

void GroupRuntime::read_links(int frames) noexcept {
    bool missed = false;
    for (std::size_t i = 0; i < program_->inputs.size(); ++i) {
        const GroupRuntime& producer = *program_->producers[i];
        if (!read_link(*program_->inputs[i], producer, frames)) continue;
        missed = true;
        producer.telemetry.awaited.fetch_add(1, std::memory_order_relaxed);
    }
    if (missed) telemetry.misses.fetch_add(1, std::memory_order_relaxed);
}

void GroupRuntime::note_readers(int frames) noexcept {
    for (const build::PublishedSnapshot& snapshot : program_->snapshots) {
        SnapshotOutput& port = *snapshot.port;
        // Whoever runs later in this call reads all that it gives; its first version is not older than those before.
        port.oldest_readable = frames > 1 ? port.type->version(port.data) : std::numeric_limits<std::int64_t>::max();
        for (const Link* link : snapshot.links)
            port.oldest_readable = std::min(port.oldest_readable, link->oldest_version(&port));
        for (const build::DelayLine* delay : snapshot.delays)
            port.oldest_readable = std::min(port.oldest_readable, delay->oldest_version());
    }
}

void GroupRuntime::publish(int frames) noexcept {
    std::size_t took = 0;
    for (Link* link : program_->outputs) {
        if (decisions_->drops(*link, next_, frames)) {
            telemetry.dropped.fetch_add(frames, std::memory_order_relaxed);
            telemetry.lost_events.fetch_add(link->drop(frames), std::memory_order_relaxed);
            continue;
        }
        if (const std::int64_t lost = link->publish(next_, frames); lost > 0)
            telemetry.lost_events.fetch_add(lost, std::memory_order_relaxed);
        ++took;
    }
    for (const build::PublishedSnapshot& snapshot : program_->snapshots)
        snapshot.port->last_was_dropped = took == 0 && snapshot.delays.empty() && !program_->outputs.empty();
}

int GroupRuntime::call(int frames) noexcept {
    begin_call(frames);
    return finish_call();
}

void GroupRuntime::begin_call(int frames) noexcept {
    ramps_.advance(next_);
    // A hand is sampled at every activation: what it feels must not depend on how long a call is.
    int n = cut(plan->has_audio && program_->devices.empty() ? frames : 1);
    // Waiting for room for several could last for ever: the reader may wait for the first of them.
    while (n > 1 && !decisions_->has_room(program_->outputs, next_, n)) n /= 2;
    begun_ = n;
    now = next_ * plan->period;
    acquire(n);
    if (is_forsaken()) return;
    RealtimeScope scope;
    check_sources();
    read_links(n);
    note_readers(n);
    run_steps(n);
}

int GroupRuntime::finish_call() noexcept {
    if (is_forsaken()) return 0;
    const int n = std::exchange(begun_, 0);
    {
        RealtimeScope scope;
        publish(n);
        for (Link* link : program_->inputs)
            if (link->changes_within_calls) link->end_call();
        hold_outputs(n);
        clear_events(n);
    }
    committing_ = n;
    double largest = 0.0;
    for (io::DeviceSlot* slot : program_->driven) {
        // The node that wrote it reads here what the device was given.
        slot->port.wrench = io::clamp_to_device(slot->port.wrench, slot->port.info);
        largest = std::max(largest, glm::length(slot->port.wrench.force));
    }
    telemetry.note_force(largest);
    for (std::size_t i = 0; i < program_->driven.size(); ++i) {
        io::DeviceSlot* const slot = program_->driven[i];
        std::string_view source;
        if (slot->overdue >= 0 && slot->port.fault == slot->port.overdue)
            source = program_->sources[i][static_cast<std::size_t>(slot->overdue)].name;
        slot->guard.note(slot->port.fault, slot->port.state, next_, glm::length(slot->committed.force), source);
        slot->committed = slot->port.wrench;
        decisions_->commit(*slot);
        if (is_forsaken()) return 0;
    }
    committing_ = 0;
    telemetry.ticks.fetch_add(n, std::memory_order_relaxed);
    last_ = next_ + n - 1;
    next_ += n;
    decisions_->pass(next_);
    computed_.store(next_, std::memory_order_release);
    done_.store(next_, std::memory_order_release);
    return n;
}

void GroupRuntime::skip_to(std::int64_t to) noexcept {
    telemetry.skipped.fetch_add(to - next_, std::memory_order_relaxed);
    constexpr std::int64_t most = std::int64_t{1} << 30;  // of one record
    for (std::int64_t at = next_; at < to; at += most)
        log.note(take::TimingKind::skipped, at, {.count = std::min(to - at, most)});
    next_ = to;
    done_.store(next_, std::memory_order_release);
}

bool GroupRuntime::skip_as_decided() noexcept {
    const std::int64_t to = decisions_->skip_from(next_);
    if (to == next_) return false;
    telemetry.skipped.fetch_add(to - next_, std::memory_order_relaxed);
    next_ = to;
    done_.store(next_, std::memory_order_release);
    return true;
}

bool GroupRuntime::forsake() noexcept {
    if (!decisions_->driver.forsake()) return false;
    // From here on the group's thread touches nothing. The forces of the last activations are computed.
    next_ += committing_;
    done_.store(next_, std::memory_order_release);
    end_at(next_);
    return true;
}

void GroupRuntime::end_at(std::int64_t tick) noexcept {
    end.store(std::min(end.load(), tick));
    log.note(take::TimingKind::end, next_, {});
    if (program_)
        for (io::DeviceSlot* slot : program_->devices) slot->guard.retire();
    // From here on nothing of the group is touched by its thread.
    over_.store(true, std::memory_order_release);
}

}  // namespace tactus::run

// SPDX-License-Identifier: Apache-2.0
#include "engine/run/group_runtime.hpp"

#include "dsp/core/realtime.hpp"
#include "engine/run/clock_decisions.hpp"
#include "engine/run/replayed_decisions.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace tactus::run {

GroupRuntime::GroupRuntime(const compile::PlanGroup& description, int number, int frames)
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

void GroupRuntime::replay(const std::vector<take::TimingRecord>& records, const std::vector<ParameterChange>& changes) {
    decisions_ = std::make_unique<ReplayedDecisions>(log, records, changes);
}

int GroupRuntime::cut(int frames) const noexcept {
    std::int64_t until =
        std::min<std::int64_t>(next_ + std::min(frames, max_frames), end.load(std::memory_order_relaxed));
    const auto cut_at = [&](std::int64_t tick) {
        if (tick > next_) until = std::min(until, tick);
    };
    for (const Link* link : program_->inputs) cut_at(link->window_end(next_));
    for (const auto& delay : program_->delays) cut_at(next_ + delay->count);
    until = decisions_->end_of_call(next_, ramps_.next_change(next_, until), upcoming_);
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

void GroupRuntime::acquire() noexcept {
    const Flicks elapsed = last_ < 0 ? 0 : (next_ - last_) * plan->period;
    for (build::DeviceSlot* slot : program_->devices) decisions_->acquire(*slot, next_, elapsed);
}

void GroupRuntime::read_links(int frames) noexcept {
    bool missed = false;
    for (std::size_t i = 0; i < program_->inputs.size(); ++i) {
        Link& link = *program_->inputs[i];
        const GroupRuntime& producer = *program_->producers[i];
        const LinkReading reading = decisions_->read(link, producer, next_, frames);
        if (reading.is_late) {
            missed = true;
            producer.telemetry.awaited.fetch_add(1, std::memory_order_relaxed);
        }
        link.read(reading.index);
        link.deliver(next_, frames);
    }
    if (missed) telemetry.misses.fetch_add(1, std::memory_order_relaxed);
}

void GroupRuntime::publish(int frames) noexcept {
    std::size_t took = 0;
    for (Link* link : program_->outputs) {
        if (decisions_->drops(*link, next_, frames)) {
            telemetry.dropped.fetch_add(frames, std::memory_order_relaxed);
            continue;
        }
        link->publish(next_, frames);
        ++took;
    }
    for (SnapshotOutput* output : program_->snapshots)
        output->last_was_dropped = took == 0 && !program_->outputs.empty();
}

int GroupRuntime::call(int frames) noexcept {
    begin_call(frames);
    return finish_call();
}

void GroupRuntime::begin_call(int frames) noexcept {
    ramps_.advance(next_);
    int n = cut(plan->has_audio ? frames : 1);
    // Who asked for room for more than one could wait for ever, for a reader that waits for the first of them.
    while (n > 1 && !decisions_->has_room(program_->outputs, next_, n)) n /= 2;
    begun_ = n;
    now = next_ * plan->period;
    acquire();
    if (is_forsaken()) return;
    RealtimeScope scope;
    read_links(n);
    for (SnapshotOutput* output : program_->snapshots) {
        output->oldest_readable = std::numeric_limits<std::int64_t>::max();
        for (const Link* link : program_->outputs)
            output->oldest_readable = std::min(output->oldest_readable, link->oldest_version(output));
    }
    for (const auto& delay : program_->delays) delay->recall(next_, n);
    run_steps(n);
    for (const auto& delay : program_->delays) delay->remember(next_, n);
}

int GroupRuntime::finish_call() noexcept {
    if (is_forsaken()) return 0;
    const int n = std::exchange(begun_, 0);
    {
        RealtimeScope scope;
        publish(n);
    }
    committing_ = n;
    for (build::DeviceSlot* slot : program_->driven) {
        telemetry.force_N.store(glm::length(slot->port.wrench.force), std::memory_order_relaxed);
        slot->guard.note(slot->port.fault, next_, glm::length(slot->committed.force));
        slot->committed = slot->port.wrench;
        decisions_->commit(*slot);
        if (is_forsaken()) return 0;
    }
    committing_ = 0;
    telemetry.ticks.fetch_add(n, std::memory_order_relaxed);
    last_ = next_ + n - 1;
    next_ += n;
    decisions_->pass(next_);
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
    // From here on the thread touches nothing, so that this one may. What the hands were to feel is computed.
    next_ += committing_;
    done_.store(next_, std::memory_order_release);
    end_at(next_);
    return true;
}

void GroupRuntime::end_at(std::int64_t tick) noexcept {
    end.store(std::min(end.load(), tick));
    log.note(take::TimingKind::end, next_, {});
    if (program_)
        for (build::DeviceSlot* slot : program_->devices) slot->guard.retire();
    // From here on nothing of the group is touched by its thread.
    over_.store(true, std::memory_order_release);
}

}  // namespace tactus::run

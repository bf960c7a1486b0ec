// SPDX-License-Identifier: Apache-2.0
// The threads of the groups in a live run.
#include "engine/run/live_run.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/realtime.hpp"
#include "engine/run/made_thread.hpp"
#include "engine/run/priority.hpp"

#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::run {

namespace {

// The scheduler wakes a sleeper late by tens of microseconds; the last stretch is spun instead, never more. Between calls
// that follow each other closely it is a quarter of what lies between them: the rest belongs to slower groups.
constexpr std::int64_t spin_ns = 80'000;
constexpr std::int64_t spun_part = 4;
constexpr std::int64_t poll_start_ns = 200'000;
constexpr std::int64_t rest_ns = 1'000'000;  // well below the watchdog's limit
// Longer sleeps are split, to check for a pause or the end of the run.
constexpr std::int64_t longest_sleep_ns = 10'000'000;

}  // namespace

bool LiveRun::pauses(const GroupRuntime& group) const {
    return parts_.time.window.stops(group.next() * group.plan->period);
}

bool LiveRun::is_over(const GroupRuntime& group) const {
    return group.finished() || parts_.time.window.ends(group.next() * group.plan->period);
}

void LiveRun::rest_while_paused(GroupRuntime& group, control::TrimmedClock& line) {
    const std::int64_t before = line.steady_ns;
    const auto rest = [&group] {
        group.rest();
        sleep_for(rest_ns);
    };
    while (pauses(group) && !is_over(group) && !group.is_forsaken()) rest();
    // The clock is set before the pause ends; a read that overlapped with the write is repeated.
    while (!is_over(group) && line.steady_ns == before) {
        line = parts_.time.clock.get(line);
        if (line.steady_ns == before) sleep_for(spin_ns);
    }
    const auto release_ns = [&] {
        line = parts_.time.clock.get(line);
        return line.when(group.next() * group.plan->period);
    };
    // Wake up in time to notice the next pause.
    while (!is_over(group) && !pauses(group) && !group.is_forsaken() && release_ns() - steady_ns() > 2 * rest_ns)
        rest();
    // The watchdog must not miss it until the first tick has computed its force.
    if (!is_over(group) && !pauses(group) && !group.is_forsaken()) group.rest();
}

void LiveRun::work(GroupThread& mine) {
    GroupRuntime& group = mine.group;
    flush_denormals_to_zero();
    // Whoever sets the clock may have been interrupted by this very thread.
    control::TrimmedClock line;
    while (!parts_.time.clock.try_get(line)) sleep_for(poll_start_ns);
    const auto release_ns = [&](std::int64_t tick) {
        line = parts_.time.clock.get(line);
        return line.when(tick * group.plan->period);
    };
    const double period_ns = options_.dilate * 1e9 / rate_of(group.plan->period);
    observe::GroupTelemetry& telemetry = group.telemetry;
    std::int64_t busy_until = 0, last_due = 0;
    observe::LateCause overrun = observe::LateCause::woken_late;
    while (!is_over(group) && !group.is_forsaken()) {
        if (pauses(group)) {
            rest_while_paused(group, line);
            continue;
        }
        const std::int64_t due = release_ns(group.next());
        if (due - steady_ns() > longest_sleep_ns) {
            group.take_program_ahead();
            sleep_until(std::min(due - spin_ns, steady_ns() + longest_sleep_ns));
            continue;
        }
        wait_until(due, std::clamp<std::int64_t>((due - last_due) / spun_part, 0, spin_ns));
        last_due = due;
        if (is_over(group) || pauses(group)) continue;
        const std::int64_t begin = steady_ns();
        telemetry.lateness.add(begin - due);
        // Still at the call before when this one was due: what held that one up is to blame.
        const observe::LateCause started = busy_until > due ? overrun : observe::LateCause::woken_late;
        const double periods_late = static_cast<double>(begin - due) / period_ns;
        // A group that may not run late ticks leaves out one that would come right before the next one.
        const bool is_exact = group.backlog() == 0 && group.max_frames == 1;
        const auto late = static_cast<std::int64_t>(periods_late + (is_exact ? 0.5 : 0.0));
        if (late > group.backlog()) {
            const std::int64_t to = std::min(group.next() + late, group.end.load());
            telemetry.skip_causes.add(started, to - group.next());
            group.skip_to(to);
            continue;
        }
        group.take_changes();
        // It may have ended before it took its first program.
        if (!group.has_program()) continue;
        const std::int64_t computed_before = thread_ns();
        group.due_ns = due;
        mine.busy_since_ns.store(begin, std::memory_order_relaxed);
        group.call(group.max_frames);
        busy_until = steady_ns();
        if (!group.is_forsaken()) mine.busy_since_ns.store(0, std::memory_order_relaxed);
        telemetry.execution.add(busy_until - begin);
        overrun = observe::blame(begin - due, started, busy_until - begin, thread_ns() - computed_before);
        if (const std::int64_t missed = telemetry.awaited.exchange(0)) telemetry.withheld.add(overrun, missed);
        if (busy_until - due > std::llround(period_ns * group.max_frames)) group.watch_closely();
    }
    if (!group.is_forsaken()) group.end_at(group.next());
}

void LiveRun::start_threads() {
    const auto& groups = parts_.timeline.now().groups;
    try {
        prepare_threads(parts_.timeline.now());
        guard(parts_.host.devices);
        watchdog_.begin();
    } catch (...) {
        cancel_threads();
        throw;
    }
    while (ready_.load() < groups.size()) sleep_for(poll_start_ns);
    line_ = {0, steady_ns() + start_delay_ns, options_.dilate};
    parts_.time.clock.set(line_);
    release_threads();
}

void LiveRun::make_thread(GroupRuntime& group, int priority) {
    group.decide_live(parts_.time.window);
    auto made = std::make_unique<GroupThread>(group, priority);
    GroupThread& mine = *made;
    threads_.push_back(std::move(made));
    try {
        mine.thread = made_thread("for the group " + group.plan->name, [this, &mine, priority] {
            if (!set_priority(pthread_self(), priority)) is_refused_ = true;
            ++ready_;
            while (mine.order == GroupThread::wait) sleep_for(poll_start_ns);
            if (mine.order == GroupThread::go) work(mine);
            if (!mine.group.is_forsaken()) mine.is_over = true;
        });
    } catch (...) {
        threads_.pop_back();
        throw;
    }
}

void LiveRun::set_priorities(const build::Generation& generation) {
    for (const auto& thread : threads_)
        for (std::size_t g = 0; g < generation.groups.size(); ++g) {
            if (generation.groups[g].get() != &thread->group) continue;
            const int wanted = priority_of(generation.plan, generation.plan.groups[g]);
            if (wanted != std::exchange(thread->priority, wanted) && thread->thread.joinable())
                priorities_.set(thread->thread.native_handle(), wanted);
        }
}

void LiveRun::cancel_threads() {
    for (const auto& thread : threads_)
        if (int expected = GroupThread::wait; thread->order.compare_exchange_strong(expected, GroupThread::cancel))
            thread->thread.join();
    std::erase_if(threads_, [](const auto& thread) { return thread->order == GroupThread::cancel; });
    set_priorities(parts_.timeline.now());
    watchdog_.forget_beyond(devices_in_use_);
}

void LiveRun::release_threads() {
    devices_in_use_ = watchdog_.watched();
    for (const auto& thread : threads_) {
        if (thread->order != GroupThread::wait) continue;
        priorities_.add(thread->group.plan->name, thread->thread.native_handle(), thread->priority,
                        thread->busy_since_ns);
        thread->order = GroupThread::go;
    }
}

void LiveRun::end_thread(const GroupRuntime& group) {
    std::erase_if(threads_, [&](const auto& thread) {
        if (&thread->group != &group) return false;
        priorities_.remove(thread->thread.native_handle());
        thread->thread.join();
        return true;
    });
}

}  // namespace tactus::run

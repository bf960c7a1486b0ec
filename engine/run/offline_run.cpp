// SPDX-License-Identifier: Apache-2.0
#include "engine/run/offline_run.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/realtime.hpp"
#include "engine/observe/observer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <thread>
#include <utility>

namespace tactus::run {

static constexpr Flicks never = std::numeric_limits<Flicks>::max();

void OfflineRun::wake_others() {
    steps_.fetch_add(1, std::memory_order_release);
    steps_.notify_all();
}

/// Leaves out what a log leaves out, and takes over the programs that are due. True when there was either: others may
/// then read, or have room.
static bool take_up(GroupRuntime& group) noexcept {
    for (bool has_changed = false;; has_changed = true) {
        while (!group.finished() && group.skip_as_decided()) has_changed = true;
        if (!group.take_changes()) return has_changed;
    }
}

void OfflineRun::await_step(std::uint32_t seen) {
    {
        const std::lock_guard lock(idle_lock_);
        if (steps_.load() != seen) return;
        if (std::exchange(idle_step_, seen) != seen) idle_ = 0;
        // Every thread has searched since the last change and found no group ready: a deadlock.
        if (++idle_ == working_) throw Error(why_it_stands());
    }
    steps_.wait(seen, std::memory_order_acquire);
}

std::string OfflineRun::why_it_stands() const {
    std::vector<std::string> waiting;
    for (const auto& group : timeline_.groups())
        if (!group->finished())
            waiting.push_back(
                fmt::format("{} at {:.4f} s", group->plan->name, seconds(group->next() * group->plan->period)));
    return fmt::format("{}: every group waits for another ({}){}",
                       options_.replay ? "the run cannot be repeated" : "the run cannot go on",
                       fmt::join(waiting, ", "),
                       options_.replay ? "; the log of its timing does not fit the patch" : "");
}

GroupRuntime* OfflineRun::earliest_ready(const std::vector<GroupRuntime*>& mine, Flicks until, bool& all_finished) {
    // Earliest first: then one thread alone never has to wait.
    GroupRuntime* earliest = nullptr;
    all_finished = true;
    const auto release = [](const GroupRuntime* g) { return g->next() * g->plan->period; };
    for (GroupRuntime* group : mine) {
        // Room in channels of the plan before may have become free.
        if (!group->has_begun() && take_up(*group)) wake_others();
        if (group->finished() || release(group) >= until) continue;
        all_finished = false;
        if (group->ready() && (!earliest || release(group) < release(earliest))) earliest = group;
    }
    return earliest;
}

void OfflineRun::step(GroupRuntime& group, int frames) {
    const std::int64_t before = steady_ns();
    if (!group.has_begun()) group.begin_call(frames);
    if (group.ready()) group.finish_call();
    group.telemetry.execution.add(steady_ns() - before);
    wake_others();
    recorder_.drain_full();
    if (options_.observer && options_.observer->wants_drain()) options_.observer->drain();
    if (const auto* ring = group.log.ring; ring && ring->size() * 2 > ring->capacity())
        recorder_.drain_journal(timeline_.groups());
}

void OfflineRun::work(const std::vector<GroupRuntime*>& mine, std::uint64_t seed) {
    flush_denormals_to_zero();
    const Random random{seed};
    std::uint64_t draws = 0;
    while (!stop_.load(std::memory_order_relaxed)) {
        const std::uint32_t seen = steps_.load(std::memory_order_acquire);
        bool all_finished = false;
        GroupRuntime* const group = earliest_ready(mine, never, all_finished);
        if (all_finished) break;
        if (!group) {
            await_step(seen);
            continue;
        }
        int frames = group->max_frames;
        if (options_.random_blocks)
            frames = 1 + static_cast<int>(random.bits(draws++) % static_cast<std::uint64_t>(frames));
        step(*group, frames);
    }
    const std::lock_guard lock(idle_lock_);
    --working_;
    wake_others();
}

void OfflineRun::run(int threads, const std::function<void(double)>& progress) {
    // The slowest groups do the heavy work: they are dealt out first, the rest shares the last thread.
    const auto& groups = timeline_.groups();
    const auto count = static_cast<std::size_t>(std::clamp<int>(threads, 1, static_cast<int>(groups.size())));
    std::vector<std::vector<GroupRuntime*>> shares(count);
    for (std::size_t i = 0; i < groups.size(); ++i)
        shares[std::min(groups.size() - 1 - i, count - 1)].push_back(groups[i].get());
    const std::uint64_t seed = timeline_.now().plan.patch.seed;
    working_ = count;
    if (count == 1 && !progress) {
        work(shares.front(), mix(seed));
        return complete();
    }
    std::atomic<std::size_t> running{count};
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < count; ++i)
        workers.emplace_back([this, &shares, &running, seed, i] {
            try {
                work(shares[i], mix(seed + i));
            } catch (...) {
                fail(std::current_exception());
            }
            --running;
        });
    while (progress && running.load() > 0) {
        try {
            progress(timeline_.progress_seconds() / options_.seconds);
        } catch (...) {
            fail(std::current_exception());
            break;
        }
        sleep_for(20'000'000);
    }
    workers.clear();
    if (failure_) std::rethrow_exception(failure_);
    complete();
}

void OfflineRun::advance(Flicks until) {
    if (advanced_.empty())
        for (const auto& group : timeline_.groups()) advanced_.push_back(group.get());
    while (!stop_.load(std::memory_order_relaxed)) {
        bool all_finished = false;
        GroupRuntime* const group = earliest_ready(advanced_, until, all_finished);
        if (all_finished) return;
        if (!group) throw Error(why_it_stands());
        const Flicks period = group->plan->period;
        step(*group,
             static_cast<int>(std::min<std::int64_t>(group->max_frames, ceil_div(until, period) - group->next())));
    }
}

void OfflineRun::complete() {
    for (const auto& group : timeline_.groups()) group->end_at(group->next());
    recorder_.drain_journal(timeline_.groups());
    recorder_.drain();
}

void OfflineRun::stop() {
    stop_ = true;
    steps_.fetch_add(1);
    steps_.notify_all();
}

void OfflineRun::fail(std::exception_ptr error) {
    const std::lock_guard lock(failure_lock_);
    if (!failure_) failure_ = std::move(error);
    stop();
}

}  // namespace tactus::run

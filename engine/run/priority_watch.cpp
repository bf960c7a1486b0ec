// SPDX-License-Identifier: Apache-2.0
#include "engine/run/priority_watch.hpp"

#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <sched.h>
#include <algorithm>

namespace tactus::run {

bool set_priority(pthread_t thread, int priority) noexcept {
    sched_param parameters{};
    parameters.sched_priority = priority;
    return pthread_setschedparam(thread, priority > 0 ? SCHED_FIFO : SCHED_OTHER, &parameters) == 0;
}

PriorityWatch::PriorityWatch() : loads_(watched_.size()) {
    demotions_.look(0, loads_);  // takes the memory that it needs
}

void PriorityWatch::lock() noexcept {
    constexpr std::int64_t wait_ns = 50'000;
    while (is_busy_.exchange(true, std::memory_order_acquire)) sleep_for(wait_ns);
}

void PriorityWatch::add(const std::string& name, pthread_t thread, int priority,
                        const std::atomic<std::int64_t>& busy_since) {
    const auto free = std::ranges::find(watched_, false, &Watched::is_used);
    if (free == watched_.end()) return;
    clockid_t clock{};
    if (pthread_getcpuclockid(thread, &clock) != 0) return;
    free->name = name;
    lock();
    free->thread = thread;
    free->clock = clock;
    free->priority = priority;
    free->busy_since = &busy_since;
    free->is_demoted = false;
    free->is_used = true;
    demotions_.forget(static_cast<std::size_t>(free - watched_.begin()));
    unlock();
}

void PriorityWatch::set(pthread_t thread, int priority) noexcept {
    lock();
    bool is_demoted = false;
    for (Watched& one : watched_) {
        if (!one.is_used || !pthread_equal(one.thread, thread)) continue;
        one.priority = priority;
        is_demoted = one.is_demoted;
    }
    if (!is_demoted) set_priority(thread, priority);
    unlock();
}

void PriorityWatch::remove(pthread_t thread) noexcept {
    lock();
    for (Watched& one : watched_)
        if (one.is_used && pthread_equal(one.thread, thread)) one.is_used = false;
    unlock();
}

void PriorityWatch::look(std::int64_t now_ns) noexcept {
    if (is_busy_.exchange(true, std::memory_order_acquire)) return;
    for (std::size_t i = 0; i < watched_.size(); ++i) {
        const Watched& one = watched_[i];
        loads_[i] = {};
        if (!one.is_used) continue;
        loads_[i] = {one.priority, one.busy_since->load(std::memory_order_relaxed), thread_ns(one.clock)};
    }
    const std::vector<DemotionCause>& causes = demotions_.look(now_ns, loads_);
    for (std::size_t i = 0; i < watched_.size(); ++i) {
        Watched& one = watched_[i];
        const bool is_demoted = causes[i] != DemotionCause::none;
        if (!one.is_used || is_demoted == one.is_demoted) continue;
        one.is_demoted = is_demoted;
        set_priority(one.thread, is_demoted ? 0 : one.priority);
        if (is_demoted) one.cause.store(static_cast<int>(causes[i]), std::memory_order_relaxed);
    }
    unlock();
}

std::vector<std::string> PriorityWatch::take_notices() {
    std::vector<std::string> notices;
    for (Watched& one : watched_) {
        const auto cause = static_cast<DemotionCause>(one.cause.exchange(0, std::memory_order_relaxed));
        if (cause == DemotionCause::none) continue;
        notices.push_back(cause == DemotionCause::no_progress
                              ? fmt::format("group '{}': one call took longer than {} ms; it ran without real-time "
                                            "priority until its calls were short again",
                                            one.name, Demotions::longest_call_ns / 1'000'000)
                              : fmt::format("group '{}': the groups used more than {:.0f} % of a core; it is the least "
                                            "critical one and ran without real-time priority for a while",
                                            one.name, Demotions::largest_load * 100.0));
    }
    return notices;
}

}  // namespace tactus::run

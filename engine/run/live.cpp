// SPDX-License-Identifier: Apache-2.0
// Real time: one thread per group on the steady clock. Nobody waits for anybody; what that decides goes to the log.
#include "engine/run/engine.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/realtime.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/run_clock.hpp"
#include "engine/run/watchdog.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace tactus::run {

namespace {

// The scheduler wakes a sleeper late by tens of microseconds; the last stretch is spun instead, never more.
constexpr std::int64_t spin_ns = 80'000;
constexpr std::int64_t start_delay_ns = 20'000'000;
constexpr std::int64_t poll_start_ns = 200'000;
constexpr Flicks pause_fade = flicks_per_second / 50;  // a fade takes 10 ms
constexpr Flicks pause_lead = flicks_per_second / 20;
constexpr std::int64_t rest_ns = 1'000'000;  // well below the watchdog's limit

void wait_until(std::int64_t when_ns) noexcept {
    const std::int64_t sleep_to = when_ns - spin_ns;
    if (steady_ns() < sleep_to) sleep_until(sleep_to);
    while (steady_ns() < when_ns) {
    }
}

/// The faster the group, the higher its priority. False when the system refuses.
bool make_real_time(Flicks period) noexcept {
    sched_param parameters{};
    // 48 kHz: 77, 1 kHz: 60, 60 Hz: 47.
    const double octaves_above_1_hz = std::log2(rate_of(period));
    parameters.sched_priority = std::clamp(30 + static_cast<int>(3.0 * octaves_above_1_hz), 10, 80);
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

/// How old the last force may be before the watchdog fades it: 3 ms, or three ticks of a slower device.
std::int64_t commit_limit_ns(const build::DeviceSlot& slot, double dilate) {
    const double ticks = 3e9 / rate_of(slot.period);
    return std::llround(std::max(3e6, ticks) * std::max(1.0, dilate));
}

}  // namespace

/// What the threads of a live run share.
struct Engine::LiveRun {
    control::TrimmedClock line;  // control thread
    RunClock clock;
    std::atomic<bool> started{false};   // not before every thread is there, whatever making them takes
    std::atomic<std::size_t> ready{0};  // threads that wait for the start
    double dilate = 1.0;
    std::atomic<std::size_t> running{0};
    std::atomic<bool> refused{false};  // real-time priority
    bool stood = false;  // time stands still, or has just begun to go on
    std::vector<std::pair<const GroupRuntime*, std::jthread>> threads;
};

void Engine::live_worker(GroupRuntime& group) {
    flush_denormals_to_zero();
    // Whoever sets the clock may have been interrupted by this very thread.
    control::TrimmedClock line;
    while (!live_->clock.try_get(line)) sleep_until(steady_ns() + poll_start_ns);
    const auto release_ns = [&](std::int64_t tick) {
        line = live_->clock.get(line);
        return line.when(tick * group.plan->period);
    };
    const double period_ns = live_->dilate * 1e9 / rate_of(group.plan->period);
    observe::GroupTelemetry& telemetry = group.telemetry;
    std::int64_t busy_until = 0;
    observe::LateCause overrun = observe::LateCause::woken_late;
    while (!group.finished()) {
        if (group.pauses()) {
            const std::int64_t before = line.steady_ns;
            const auto rest = [&group] {
                group.rest();
                sleep_until(steady_ns() + rest_ns);
            };
            while (group.pauses() && !group.finished()) rest();
            // The clock is set before the pause ends; a reader that was unlucky looks again.
            while (!group.finished() && line.steady_ns == before) {
                line = live_->clock.get(line);
                if (line.steady_ns == before) sleep_until(steady_ns() + spin_ns);
            }
            while (!group.finished() && release_ns(group.next()) - steady_ns() > 2 * rest_ns) rest();
            continue;
        }
        const std::int64_t due = release_ns(group.next());
        wait_until(due);
        const std::int64_t begin = steady_ns();
        telemetry.lateness.add(begin - due);
        // Still at the call before when this one was due: what held that one up is to blame.
        const observe::LateCause started = busy_until > due ? overrun : observe::LateCause::woken_late;
        const auto late = static_cast<std::int64_t>(static_cast<double>(begin - due) / period_ns);
        if (late > group.backlog()) {
            const std::int64_t to = std::min(group.next() + late, group.end.load());
            telemetry.skip_causes.add(started, to - group.next());
            group.skip_to(to);
            continue;
        }
        group.take_changes(Pace::live);
        const std::int64_t computed_before = thread_ns();
        group.call(group.max_frames, Pace::live);
        busy_until = steady_ns();
        telemetry.execution.add(busy_until - begin);
        overrun = observe::blame(begin - due, started, busy_until - begin, thread_ns() - computed_before);
        if (const std::int64_t missed = telemetry.awaited.exchange(0)) telemetry.withheld.add(overrun, missed);
        if (busy_until - due > std::llround(period_ns * group.max_frames)) group.watch_closely();
    }
    group.end_at(group.next());
}

void Engine::start_thread(GroupRuntime& group) {
    ++live_->running;
    group.pause = &pause_;
    live_->threads.emplace_back(&group, [this, &group] {
        if (!make_real_time(group.plan->period)) live_->refused = true;
        ++live_->ready;
        while (!live_->started.load()) sleep_until(steady_ns() + poll_start_ns);
        live_worker(group);
        --live_->running;
    });
}

void Engine::end_thread(const GroupRuntime& group) {
    std::erase_if(live_->threads, [&](const auto& thread) { return thread.first == &group; });
}

Engine::Pausing Engine::pausing() const {
    const Flicks stop = pause_.stop.load();
    if (stop == PauseWindow::never) return Pausing::runs;
    const bool all = std::ranges::all_of(now_->groups, [stop](const auto& group) {
        return group->is_over() || group->done() * group->plan->period >= stop;
    });
    return all ? Pausing::stands : Pausing::fades;
}

/// Nobody is asked to stop at once: a pause begins a little ahead of the furthest group, so that all stand at one logical
/// time; and it ends with a clock that was set to go on from there.
void Engine::service_pause() {
    const Pausing state = pausing();
    if (state == Pausing::runs && wants_pause_) {
        const Flicks stop = furthest() + pause_lead;
        pause_.fade = PauseWindow::never;
        pause_.until = PauseWindow::never;
        pause_.stop = stop;
        pause_.fade = stop - pause_fade;
    } else if (state == Pausing::stands && !wants_pause_) {
        const Flicks stop = pause_.stop.load();
        live_->line.steady_ns += steady_ns() + start_delay_ns - live_->line.when(stop);
        live_->clock.set(live_->line);
        pause_.until = stop + pause_fade;
        pause_.stop = PauseWindow::never;
    }
    live_->stood = pausing() != Pausing::runs;
}

/// The clock follows the first card that is there. When one is lost, all hands are let go of once.
void Engine::service_cards() {
    bool follows = false;
    for (const auto& card : host_.cards) {
        // Sound at another pace than that of its card cannot be followed.
        control::TrimmedClock* const line = follows || live_->dilate != 1.0 || live_->stood ? nullptr : &live_->line;
        if (card->service(steady_ns(), furthest(), line)) {
            for (const auto& slot : host_.devices) slot->guard.ask_fade();
            host_.notices.push_back(
                fmt::format("{} was lost at {:.1f} s: no callback came for {} ms; forces faded "
                            "once and the run went on silent",
                            card->name(), seconds(furthest()), io::SoundCard::longest_silence_ns / 1'000'000));
        }
        follows = follows || !card->is_lost();
    }
    live_->clock.set(live_->line);
}

void Engine::run_live(const LiveOptions& options) {
    if (options.log) log_ = std::make_unique<take::TimingLogWriter>(*options.log, plan_hash_, options_.seconds);
    for (const auto& group : groups_)
        if ((log_ || options_.take) && !group->log) add_log(*group);
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
        host_.notices.push_back(
            "memory could not be locked: a page fault may delay a tick (run as root or raise RLIMIT_MEMLOCK)");
    LiveRun run;
    live_ = &run;
    run.dilate = options.dilate;
    Watchdog watchdog;
    const auto watch_devices = [&] {
        while (watchdog.watched() < host_.devices.size()) {
            build::DeviceSlot& slot = *host_.devices[watchdog.watched()];
            slot.guard.set_limit(commit_limit_ns(slot, run.dilate));
            watchdog.watch(slot);
        }
    };
    watch_devices();
    for (const auto& group : now_->groups) start_thread(*group);
    while (run.ready.load() < now_->groups.size()) sleep_until(steady_ns() + poll_start_ns);
    run.line = {0, steady_ns() + start_delay_ns, options.dilate};
    run.clock.set(run.line);
    run.started = true;
    bool stopping = false;
    while (run.running.load() > 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        try {
            drain_log();
            drain_streams();
            note_losses();
            for (const auto& stream : host_.streams)
                if (std::string message = stream->take_message(); !message.empty())
                    host_.notices.push_back(std::move(message));
            service_pause();
            service_record();
            service_edits();
            watch_devices();
            service_cards();
            if (options.watch) options.watch();
        } catch (...) {
            fail(std::current_exception());
            for (const auto& group : groups_) group->end = 0;
            break;
        }
        const bool is_asked = options.stop && options.stop->load();
        if (is_asked) pause(false);
        if (is_asked && !stopping && pausing() == Pausing::runs) {
            stopping = true;
            // All groups end at one logical time, a little ahead of the furthest.
            const Flicks end = furthest() + flicks_per_second / 20;
            for (const auto& group : groups_)
                group->end = std::min(group->end.load(), ceil_div(end, group->plan->period));
        }
    }
    run.threads.clear();
    if (building_.valid()) building_.wait();
    live_ = nullptr;
    munlockall();
    if (failure_) std::rethrow_exception(failure_);
    drain_log();
    drain_streams();
    if (run.refused)
        host_.notices.push_back(
            "real-time priority was refused: expect late ticks (run as root or raise RLIMIT_RTPRIO)");
    if (std::ranges::any_of(groups_, [](const auto& group) { return group->log_overflow.load(); })) {
        constexpr const char* why = "the timing log could not keep up; the run cannot be repeated";
        log_.reset();
        if (options_.take) options_.take->lose(why);
        if (options.log || was_recorded_) note_loss(why);
    }
    if (log_) complete_log();
    note_losses();
}

}  // namespace tactus::run

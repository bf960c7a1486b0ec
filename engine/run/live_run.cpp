// SPDX-License-Identifier: Apache-2.0
// The control thread of a live run. The threads of the groups are in group_thread.cpp.
#include "engine/run/live_run.hpp"

#include "dsp/core/error.hpp"
#include "engine/run/clock.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

namespace tactus::run {

namespace {

constexpr Flicks end_lead = flicks_per_second / 20;

/// How old the last force may be before the watchdog fades it: 3 ms, or three ticks of a slower device.
std::int64_t commit_limit_ns(const build::DeviceSlot& slot, double dilate) {
    const double ticks = 3e9 / rate_of(slot.period);
    return std::llround(std::max(3e6, ticks) * std::max(1.0, dilate));
}

}  // namespace

/// The clock follows the first card that is there. When one is lost, all hands are let go of once.
void LiveRun::service_cards() {
    bool follows = false;
    for (const auto& card : parts_.host.cards) {
        // Sound at another pace than that of its card cannot be followed.
        control::TrimmedClock* const line = follows || options_.dilate != 1.0 || is_still_ ? nullptr : &line_;
        const Flicks reached = parts_.timeline.furthest();
        if (card->service(steady_ns(), reached, line)) {
            for (const auto& slot : parts_.host.devices) slot->guard.ask_fade();
            parts_.host.notices.push_back(
                fmt::format("{} was lost at {:.1f} s: no callback came for {} ms; forces faded "
                            "once and the run went on silent",
                            card->name(), seconds(reached), io::SoundCard::longest_silence_ns / 1'000'000));
        }
        follows = follows || !card->is_lost();
    }
    clock_.set(line_);
}

void LiveRun::service_pause() {
    parts_.pause.service(line_, clock_);
    is_still_ = parts_.pause.state() != Pausing::runs;
}

void LiveRun::watch_devices() {
    while (watchdog_.watched() < parts_.host.devices.size()) {
        build::DeviceSlot& slot = *parts_.host.devices[watchdog_.watched()];
        slot.guard.set_limit(commit_limit_ns(slot, options_.dilate));
        watchdog_.watch(slot);
    }
}

void LiveRun::service() {
    parts_.recorder.drain_journal(parts_.timeline.groups());
    parts_.recorder.drain();
    parts_.recorder.note_losses();
    for (const auto& stream : parts_.host.streams)
        if (std::string message = stream->take_message(); !message.empty())
            parts_.host.notices.push_back(std::move(message));
    service_pause();
    parts_.recorder.service(parts_.timeline, parts_.edits.is_building());
    parts_.edits.service({[this](GroupRuntime& group) { start_thread(group); },
                          [this](const GroupRuntime& group) { end_thread(group); }});
    watch_devices();
    if (parts_.host.service_devices()) must_end_ = true;
    service_cards();
    if (options_.watch) options_.watch();
}

void LiveRun::service_stop() {
    if (!must_end_ && (!options_.stop || !options_.stop->load())) return;
    parts_.pause.want(false);
    if (is_stopping_ || parts_.pause.state() != Pausing::runs) return;
    is_stopping_ = true;
    const Flicks end = parts_.timeline.furthest() + end_lead;
    for (const auto& group : parts_.timeline.groups())
        group->end = std::min(group->end.load(), ceil_div(end, group->plan->period));
}

void LiveRun::run() {
    for (const auto& group : parts_.timeline.groups()) parts_.recorder.attach(*group);
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
        parts_.host.notices.push_back(
            "memory could not be locked: a page fault may delay a tick (run as root or raise RLIMIT_MEMLOCK)");
    watch_devices();
    start_threads();
    std::exception_ptr failure;
    while (running_.load() > 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        try {
            service();
        } catch (...) {
            failure = std::current_exception();
            for (const auto& group : parts_.timeline.groups()) group->end = 0;
            break;
        }
        service_stop();
    }
    threads_.clear();
    parts_.edits.wait();
    munlockall();
    if (failure) std::rethrow_exception(failure);
    complete();
}

void LiveRun::complete() {
    const auto& groups = parts_.timeline.groups();
    parts_.recorder.drain_journal(groups);
    parts_.recorder.drain();
    if (is_refused_)
        parts_.host.notices.push_back(
            "real-time priority was refused: expect late ticks (run as root or raise RLIMIT_RTPRIO)");
    if (std::ranges::any_of(groups, [](const auto& group) { return group->log.overflow.load(); }))
        parts_.recorder.lose_journal("the timing log could not keep up; the run cannot be repeated",
                                     options_.log.has_value());
    parts_.recorder.close_log();
    parts_.recorder.note_losses();
}

}  // namespace tactus::run

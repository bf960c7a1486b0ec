// SPDX-License-Identifier: Apache-2.0
// The control thread of a live run. The threads of the groups are in group_thread.cpp.
#include "engine/run/live_run.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "engine/run/priority.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <exception>

namespace tactus::run {

namespace {

// A driver that blocks for so long after the end is left behind.
constexpr std::int64_t longest_block_ns = 200'000'000;

/// How old the last force may be before the watchdog fades it: 3 ms, or three ticks of a slower device.
std::int64_t commit_limit_ns(const io::DeviceSlot& slot, double dilate) {
    const double ticks = 3e9 / rate_of(slot.period);
    return std::llround(std::max(3e6, ticks) * std::max(1.0, dilate));
}

}  // namespace

LiveRun::LiveRun(const LiveParts& parts, const LiveOptions& options)
    : parts_(parts), options_(options), present_(parts.time), watchdog_([this] { look(); }) {}

LiveRun::~LiveRun() { cancel_threads(); }

/// The clock follows the first available card. When a card is lost, all forces are released once.
void LiveRun::service_cards() {
    bool follows = false;
    for (const auto& card : parts_.host.cards) {
        // Sound at another pace than that of its card cannot be followed.
        control::TrimmedClock* const line = follows || options_.dilate != 1.0 || is_still_ ? nullptr : &line_;
        const Flicks reached = present_.now();
        if (card->service(steady_ns(), reached, line)) {
            for (const auto& slot : parts_.host.devices) slot->guard.ask_fade();
            parts_.host.notices.push_back(
                fmt::format("{} was lost at {:.1f} s: no callback came for {} ms; forces faded "
                            "once and the run went on silent",
                            card->name(), seconds(reached), io::SoundCard::longest_silence_ns / 1'000'000));
        }
        follows = follows || !card->is_lost();
    }
    parts_.time.clock.set(line_);
}

void LiveRun::service_pause() {
    if (parts_.pause.service(line_)) watchdog_.take_up();
    is_still_ = parts_.pause.state() != Pausing::runs;
}

void LiveRun::look() noexcept {
    const bool stops = must_end_ || (options_.stop && options_.stop->load());
    if (stops ? parts_.pause.end() : parts_.pause.begin_if_wanted()) watchdog_.let_go();
    priorities_.look(steady_ns());
}

void LiveRun::note_old_values() {
    if (is_still_) return;
    constexpr int noted_periods = 3;
    const Flicks now = present_.now();
    for (const auto& program : parts_.timeline.now().programs)
        for (const auto& sources : program->sources)
            for (const build::ValueSource& source : sources) {
                const GroupRuntime& group = *source.group;
                const Flicks late = now - group.computed() * group.plan->period - source.latency;
                const Flicks period = group.max_frames * group.plan->period;  // of its calls
                if (source.fault != control::Fault::old_world || group.is_over() || late < noted_periods * period ||
                    !noted_sources_.insert(source.name).second)
                    continue;
                parts_.host.notices.push_back(fmt::format(
                    "{}: its values were {} periods late at {:.2f} s; the hand felt the last ones, and would feel "
                    "nothing after 1 s",
                    source.name, late / period, seconds(now)));
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
    note_old_values();
    for (std::string& notice : priorities_.take_notices())
        if (noted_demotions_.insert(notice).second) parts_.host.notices.push_back(std::move(notice));
    parts_.recorder.service(parts_.timeline, parts_.edits.is_building(), present_.now());
    parts_.edits.service({.prepare = [this](const build::Generation& next) { prepare_threads(next); },
                          .release = [this] { release_threads(); },
                          .cancel = [this] { cancel_threads(); },
                          .end = [this](const GroupRuntime& group) { end_thread(group); }});
    if (parts_.host.service_devices()) must_end_ = true;
    service_cards();
    if (options_.watch) options_.watch();
}

void LiveRun::guard(const std::vector<std::unique_ptr<io::DeviceSlot>>& devices) {
    for (const auto& slot : devices) {
        slot->guard.set_limit(commit_limit_ns(*slot, options_.dilate));
        watchdog_.watch(*slot);
    }
}

void LiveRun::prepare_threads(const build::Generation& next) {
    guard(parts_.host.opened_devices());
    for (std::size_t g = 0; g < next.groups.size(); ++g)
        if (next.group_is_new[g]) make_thread(*next.groups[g], priority_of(next.plan, next.plan.groups[g]));
    set_priorities(next);
}

bool LiveRun::all_over() const {
    return std::ranges::all_of(threads_, [](const auto& thread) { return thread->is_over.load(); });
}

void LiveRun::leave_blocked() {
    const std::int64_t now = steady_ns();
    const Flicks time = present_.now();
    for (const auto& thread : threads_) {
        GroupRuntime& group = thread->group;
        const bool should_be_over = parts_.time.window.ends(time) || time >= group.end.load() * group.plan->period;
        if (thread->is_over || !should_be_over) continue;
        if (thread->late_since_ns == 0 || thread->done != group.done()) {
            thread->late_since_ns = now;
            thread->done = group.done();
        }
        if (now - thread->late_since_ns < longest_block_ns || !group.forsake()) continue;
        priorities_.remove(thread->thread.native_handle());
        thread->thread.detach();
        thread->is_over = true;
        has_left_threads_ = true;
        parts_.host.notices.push_back(
            fmt::format("a driver of the group {} did not return; it was left behind", group.plan->name));
    }
}

void LiveRun::run() {
    for (const auto& group : parts_.timeline.groups()) parts_.recorder.attach(*group);
    if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
        parts_.host.notices.push_back(
            "memory could not be locked: a page fault may delay a tick (run as root or raise RLIMIT_MEMLOCK)");
    start_threads();
    std::exception_ptr failure;
    while (!all_over()) {
        sleep_for(20'000'000);
        try {
            if (!failure) service();
        } catch (...) {
            failure = std::current_exception();
            must_end_ = true;
        }
        leave_blocked();
    }
    end_all();
    if (failure) std::rethrow_exception(failure);
    complete();
}

/// Nobody is waited for who is blocked in a driver.
void LiveRun::end_all() {
    for (const auto& thread : threads_) {
        if (!thread->thread.joinable()) continue;
        priorities_.remove(thread->thread.native_handle());
        thread->thread.join();
    }
    for (const auto& slot : parts_.host.devices) slot->guard.retire();
    if (!watchdog_.farewell()) has_left_threads_ = true;
    if (!parts_.edits.end()) has_left_threads_ = true;
    munlockall();
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

// SPDX-License-Identifier: Apache-2.0
#include "engine/group_runtime.hpp"

#include "dsp/core/realtime.hpp"
#include "engine/clock.hpp"
#include "engine/observed_port.hpp"
#include "graph/node_memory.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

namespace tactus {

const TimingRecord* GroupRuntime::replayed_at(TimingKind kind, std::uint32_t source, std::int64_t tick) const noexcept {
    if (!replayed) return nullptr;
    for (std::size_t i = cursor_; i < replayed->size(); ++i) {
        const TimingRecord& record = (*replayed)[i];
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
            const TimingRecord& record = (*replayed)[i];
            if (record.tick >= until) break;
            cut_at(record.tick > next_ ? record.tick : record.tick + record.count);
        }
    }
    return static_cast<int>(std::max<std::int64_t>(until - next_, 1));
}

void GroupRuntime::apply_parameters() noexcept {
    if (replayed) {
        for (std::size_t i = cursor_; i < replayed->size() && (*replayed)[i].tick <= next_; ++i) {
            const TimingRecord& record = (*replayed)[i];
            if (record.kind != TimingKind::parameter || record.tick != next_) continue;
            const ParameterChange& change = (*replayed_changes)[static_cast<std::size_t>(record.value)];
            change.param->value = change.value;
        }
        return;
    }
    while (has_change_ || (has_change_ = changes_.pop(change_))) {
        if (change_.when > next_ * plan->period) return;
        change_.param->value = change_.value;
        note(TimingKind::parameter, 0, 0, change_.id, nullptr);
        has_change_ = false;
    }
}

void GroupRuntime::hold_off() noexcept {
    for (DeviceSlot* slot : program_->driven) slot->port.hold_off = fades_for_plan_ || is_paused_;
}

void GroupRuntime::apply_pause(Pace pace) noexcept {
    bool wanted = is_paused_;
    if (replayed) {
        if (const TimingRecord* logged = replayed_at(TimingKind::fade, 1, next_)) wanted = logged->value != 0;
    } else if (pause) {
        wanted = pause->holds_off(next_ * plan->period);
    }
    if (wanted == is_paused_) return;
    is_paused_ = wanted;
    hold_off();
    if (pace == Pace::live) note(TimingKind::fade, 1, 0, wanted ? 1 : 0, nullptr);
}

void GroupRuntime::rest() noexcept {
    if (!program_) return;  // made by an edit while the run stands
    for (DeviceSlot* slot : program_->driven) slot->guard.commit(*slot->device, {}, steady_ns());
}

void GroupRuntime::take_over(GroupProgram& next) noexcept {
    if (program_) {
        fades_for_plan_ = false;
        hold_off();
        program_->ran = ran_;
        for (PublishedOutput& output : next.published) {
            if (output.before < 0) continue;
            const PublishedOutput& old = program_->published[static_cast<std::size_t>(output.before)];
            output.hash = old.hash;
            output.samples = old.samples;
        }
    }
    for (const MovedOutput& output : next.moved) {
        std::memcpy(output.to, output.port->data, output.bytes);
        output.port->data = output.to;
    }
    for (const auto& [input, wired] : next.wiring) *input = *wired;
    for (const auto& [param, value] : next.params) param->value = value;
    for (const auto& delay : next.delays)
        if (delay->before) delay->history.swap(delay->before->history);
    for (Link* link : next.ended) link->abandon();
    for (Link* link : next.new_inputs) link->take_over();
    for (Link* link : next.new_outputs) link->begin_at(next_);
    program_ = &next;
    if (is_paused_) hold_off();
    generation_.store(next.generation, std::memory_order_release);
}

bool GroupRuntime::take_changes(Pace pace) noexcept {
    const RealtimeScope scope;
    bool took_over = false;
    for (;;) {
        if (finished()) return took_over;
        if (!upcoming_ && taken_ < scheduled.size()) upcoming_ = scheduled[taken_++];
        if (!upcoming_) programs_.pop(upcoming_);
        if (program_) {
            apply_parameters();
            apply_pause(pace);
        }
        if (!upcoming_ || !switch_if_due(pace)) return took_over;
        took_over = true;
    }
}

bool GroupRuntime::switch_if_due(Pace pace) noexcept {
    const Flicks time = next_ * plan->period;
    // The first program of a group is not in the log.
    const bool is_logged = replayed && program_;
    const TimingRecord* logged = is_logged ? replayed_at(TimingKind::plan, 0, next_) : nullptr;
    const bool must_switch =
        is_logged ? logged && logged->value == upcoming_->generation : time >= upcoming_->switch_time;
    if (must_switch) {
        if (pace == Pace::live && program_) note(TimingKind::plan, 0, 0, upcoming_->generation, nullptr);
        take_over(*upcoming_);
        upcoming_ = nullptr;
        return true;
    }
    const bool must_fade = is_logged ? replayed_at(TimingKind::fade, 0, next_) != nullptr
                                     : program_ && !fades_for_plan_ && time >= upcoming_->fade_time &&
                                           upcoming_->fade_time < upcoming_->switch_time;
    if (must_fade) {
        fades_for_plan_ = true;
        hold_off();
        if (pace == Pace::live) note(TimingKind::fade, 0, 0, 0, nullptr);
    }
    return false;
}

bool GroupRuntime::ready() const noexcept {
    for (std::size_t i = 0; i < program_->inputs.size(); ++i) {
        const Link& link = *program_->inputs[i];
        std::int64_t wanted = link.wanted(next_);
        if (const TimingRecord* held = replayed_at(TimingKind::held_read, static_cast<std::uint32_t>(link.id), next_))
            wanted = held->value;
        const GroupRuntime& producer = *program_->producers[i];
        wanted = std::min(wanted, producer.end.load(std::memory_order_relaxed) - 1);
        if (wanted >= 0 && producer.done() <= wanted) return false;
    }
    const int frames = cut(max_frames);
    for (const Link* link : program_->outputs)
        if (!replayed_at(TimingKind::dropped, static_cast<std::uint32_t>(link->id), next_) &&
            !link->has_room(next_, frames))
            return false;
    return true;
}

void GroupRuntime::note(TimingKind kind, int source, std::int64_t count, std::int64_t value,
                        const DeviceSample* sample) noexcept {
    if (!log) return;
    TimingRecord record;
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
    for (DeviceSlot* slot : program_->devices) {
        const TimingRecord* logged =
            replayed_at(TimingKind::device_sample, static_cast<std::uint32_t>(slot->id), next_);
        slot->port.sample = logged ? logged->sample : slot->device->acquire(seconds(elapsed));
        if (!logged) {
            slot->port.sample.taken = slot->guard.was_taken();
            slot->port.sample.sound_lost = slot->guard.is_asked_to_fade();
        }
        note(TimingKind::device_sample, slot->id, 1, 0, &slot->port.sample);
    }
}

void GroupRuntime::read_links(int frames, Pace pace) noexcept {
    bool missed = false;
    for (std::size_t i = 0; i < program_->inputs.size(); ++i) {
        Link& link = *program_->inputs[i];
        const GroupRuntime& producer = *program_->producers[i];
        const std::int64_t want = link.wanted(next_);
        std::int64_t chosen = link.used();
        if (const TimingRecord* held = replayed_at(TimingKind::held_read, static_cast<std::uint32_t>(link.id), next_))
            chosen = held->value;
        else if (want > chosen) chosen = link.newest_available(want, producer.done());
        // Past the producer's last activation there is nothing to miss. Live, its end may still be set behind where it
        // is by then: only when it is over is it known which was the last.
        std::int64_t last = producer.end.load(std::memory_order_relaxed) - 1;
        if (pace == Pace::live) last = producer.is_over() ? producer.done() - 1 : Link::unknown;
        if (chosen < std::min(want, last) && link.misses(want)) {
            missed = true;
            producer.telemetry.awaited.fetch_add(1, std::memory_order_relaxed);
            if (pace == Pace::live) note(TimingKind::held_read, link.id, frames, chosen, nullptr);
        }
        link.read(chosen);
        link.deliver(next_, frames);
    }
    if (missed) telemetry.misses.fetch_add(1, std::memory_order_relaxed);
}

void GroupRuntime::drive(const StepWires& step, int i) noexcept {
    for (const Drive& drive : step.drives) {
        const std::byte* value = drive.source
                                     ? drive.source->data + i * drive.source->stride
                                     : drive.glide->glide.data() + static_cast<std::size_t>(i) * sizeof(double);
        drive.param->drive(*reinterpret_cast<const double*>(value));
    }
}

void GroupRuntime::run_one_at_a_time(const Step& step, const StepWires& of, const Tick& all) noexcept {
    const std::span<PublishedOutput> mine(program_->published.data() + step.first_output, step.output_count);
    for (int i = 0; i < all.frames; ++i) {
        drive(of, i);
        step.process(step.node, {all.index + i, all.period, i == 0 ? all.elapsed : all.period, 1});
        for (Input* input : of.inputs) {
            // A batch from another group belongs to the first activation of a call.
            if (input->kind == InputKind::batch && input->times != &now) input->count = 0;
            else input->data += input->stride;
        }
        for (PublishedOutput& output : mine) output.port->data += output.port->stride;
    }
    for (Input* input : of.inputs)
        if (input->kind != InputKind::batch || input->times == &now) input->data -= all.frames * input->stride;
    for (PublishedOutput& output : mine) output.port->data -= all.frames * output.port->stride;
}

void GroupRuntime::hash_outputs(const Step& step, int frames) noexcept {
    const auto position = static_cast<std::uint64_t>(ran_);
    for (std::uint32_t k = step.first_output; k < step.first_output + step.output_count; ++k) {
        PublishedOutput& output = program_->published[k];
        const std::byte* data = output.port->data;
        if (output.is_signal) {
            const auto* samples = reinterpret_cast<const float*>(data);
            if (frames == 1) output.samples.add(position, *samples);
            else output.samples.add(position, samples, static_cast<std::size_t>(frames));
        } else {
            for (int i = 0; i < frames; ++i) output.port->type->hash(output.hash, data + i * output.port->stride);
        }
    }
}

void GroupRuntime::record_outputs(const Step& step, int frames) noexcept {
    for (std::uint32_t k = step.first_output; k < step.first_output + step.output_count; ++k) {
        PublishedOutput& output = program_->published[k];
        if (RecordStream* const stream = output.recorded_into())
            stream->write(next_, output.port->data, static_cast<std::size_t>(frames), output.port->stride);
        if (output.seen)
            output.seen->see(next_, output.port->data, static_cast<std::size_t>(frames), output.port->stride);
    }
}

/// Asks for the cache line of a node's ports and first parameters, a few steps before they are needed: nodes are
/// scattered, and a thousand of them do not fit the nearest cache.
static void fetch_ahead(const Step* step, const Step* past) noexcept {
    constexpr std::ptrdiff_t distance = 4;
    if (past - step <= distance) return;
    __builtin_prefetch(static_cast<const std::byte*>(step[distance].node) + (cache_line - node_offset));
}

template <bool watched>
void GroupRuntime::run_each(const Tick& tick, bool timed) noexcept {
    const GroupProgram& program = *program_;
    const Step* const past = program.steps.data() + program.steps.size();
    [[maybe_unused]] std::int64_t began = watched && timed ? steady_ns() : 0;
    for (const Step& step : program.steps) {
        fetch_ahead(&step, past);
        if (!step.driven && !(step.one_at_a_time && tick.frames > 1)) {
            step.process(step.node, tick);
        } else if (const StepWires& of = program.wires[static_cast<std::size_t>(&step - program.steps.data())];
                   tick.frames == 1) {
            drive(of, 0);
            step.process(step.node, tick);
        } else {
            run_one_at_a_time(step, of, tick);
        }
        if constexpr (watched) {
            if (program.hashes_outputs) hash_outputs(step, tick.frames);
            if (program.records_outputs) record_outputs(step, tick.frames);
            if (!timed) continue;
            const std::int64_t now_ns = steady_ns();
            program.wires[static_cast<std::size_t>(&step - program.steps.data())].time->add(now_ns - began);
            began = now_ns;
        }
    }
}

void GroupRuntime::run_steps(int frames) noexcept {
    const Flicks elapsed = last_ < 0 ? plan->period : (next_ - last_) * plan->period;
    const Tick tick{next_, plan->period, elapsed, frames};
    const bool timed = times_nodes && (calls_++ % timed_every == 0 || closely_ > 0);
    closely_ = std::max(closely_ - 1, 0);
    if (timed || program_->hashes_outputs || program_->records_outputs) run_each<true>(tick, timed);
    else run_each<false>(tick, false);
    ran_ += frames;
}

void GroupRuntime::publish(int frames, Pace pace) noexcept {
    std::size_t took = 0;
    for (Link* link : program_->outputs) {
        const auto id = static_cast<std::uint32_t>(link->id);
        const bool drop = pace == Pace::live ? !link->has_room(next_, frames)
                                             : replayed_at(TimingKind::dropped, id, next_) != nullptr;
        if (drop) {
            telemetry.dropped.fetch_add(frames, std::memory_order_relaxed);
            if (pace == Pace::live) note(TimingKind::dropped, link->id, frames, 0, nullptr);
            continue;
        }
        link->publish(next_, frames);
        ++took;
    }
    for (SnapshotOutput* output : program_->snapshots)
        output->last_was_dropped = took == 0 && !program_->outputs.empty();
}

int GroupRuntime::call(int frames, Pace pace) noexcept {
    const int n = cut(plan->has_audio ? frames : 1);
    now = next_ * plan->period;
    acquire();
    {
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
        publish(n, pace);
    }
    for (DeviceSlot* slot : program_->driven) {
        telemetry.force_N.store(glm::length(slot->port.wrench.force), std::memory_order_relaxed);
        slot->guard.note(slot->port.fault, next_, glm::length(slot->committed.force));
        slot->committed = slot->port.wrench;
        if (pace == Pace::live) slot->guard.commit(*slot->device, slot->port.wrench, steady_ns());
        else if (!replayed) slot->device->commit(bearable(slot->port.wrench, slot->port.info));
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
    note(TimingKind::skipped, 0, to - next_, 0, nullptr);
    next_ = to;
    done_.store(next_, std::memory_order_release);
}

bool GroupRuntime::replay_skip() noexcept {
    const TimingRecord* record = replayed_at(TimingKind::skipped, 0, next_);
    if (!record) return false;
    telemetry.skipped.fetch_add(record->count, std::memory_order_relaxed);
    next_ = record->tick + record->count;
    done_.store(next_, std::memory_order_release);
    return true;
}

void GroupRuntime::end_at(std::int64_t tick) noexcept {
    end.store(std::min(end.load(), tick));
    note(TimingKind::end, 0, 0, 0, nullptr);
    if (program_)
        for (DeviceSlot* slot : program_->devices) slot->guard.retire();
    // From here on nothing of the group is touched by its thread.
    over_.store(true, std::memory_order_release);
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
#include "engine/group_runtime.hpp"

#include "dsp/core/realtime.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

namespace tactus {

const TimingRecord* GroupRuntime::replayed_at(TimingKind kind, std::uint16_t source, std::int64_t tick) const noexcept {
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
    for (const Link* link : inputs) until = std::min(until, link->window_end(next_));
    for (const DelayLine& delay : delays) until = std::min(until, next_ + delay.count);
    if (replayed) {
        // A logged decision begins or ends only between calls.
        for (std::size_t i = cursor_; i < replayed->size(); ++i) {
            const TimingRecord& record = (*replayed)[i];
            if (record.tick >= until) break;
            if (record.tick > next_) until = record.tick;
            else if (record.tick + record.count > next_) until = std::min(until, record.tick + record.count);
        }
    }
    return static_cast<int>(std::max<std::int64_t>(until - next_, 1));
}

bool GroupRuntime::ready() const noexcept {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Link& link = *inputs[i];
        std::int64_t wanted = link.wanted(next_);
        if (const TimingRecord* held = replayed_at(TimingKind::held_read, static_cast<std::uint16_t>(link.id), next_))
            wanted = held->value;
        wanted = std::min(wanted, producers[i]->end.load(std::memory_order_relaxed) - 1);
        if (wanted >= 0 && producers[i]->done() <= wanted) return false;
    }
    const int frames = cut(max_frames);
    for (const Link* link : outputs)
        if (!replayed_at(TimingKind::dropped, static_cast<std::uint16_t>(link->id), next_) &&
            !link->has_room(next_, frames))
            return false;
    return true;
}

void GroupRuntime::note(TimingKind kind, int source, std::int64_t count, std::int64_t value,
                        const DeviceSample* sample) noexcept {
    if (!log) return;
    TimingRecord record;
    record.kind = kind;
    record.group = static_cast<std::uint8_t>(index);
    record.source = static_cast<std::uint16_t>(source);
    record.count = static_cast<std::int32_t>(count);
    record.tick = next_;
    record.value = value;
    if (sample) record.sample = *sample;
    if (!log->push(record)) log_overflow.store(true, std::memory_order_relaxed);
}

void GroupRuntime::acquire(Pace pace) noexcept {
    const Flicks elapsed = last_ < 0 ? 0 : (next_ - last_) * plan->period;
    for (DeviceSlot* slot : devices) {
        const TimingRecord* logged =
            replayed_at(TimingKind::device_sample, static_cast<std::uint16_t>(slot->id), next_);
        slot->port.sample = logged ? logged->sample : slot->device->acquire(seconds(elapsed));
        if (pace == Pace::live) note(TimingKind::device_sample, slot->id, 1, 0, &slot->port.sample);
    }
}

void GroupRuntime::read_links(int frames, Pace pace) noexcept {
    bool missed = false;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        Link& link = *inputs[i];
        const std::int64_t want = link.wanted(next_);
        std::int64_t chosen = link.used();
        if (const TimingRecord* held = replayed_at(TimingKind::held_read, static_cast<std::uint16_t>(link.id), next_))
            chosen = held->value;
        else if (want > chosen) chosen = link.newest_available(want, producers[i]->done());
        // Past the producer's last activation there is nothing to miss.
        if (chosen < std::min(want, producers[i]->end.load(std::memory_order_relaxed) - 1)) {
            missed = true;
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
    const std::span<PublishedOutput> mine(published.data() + step.first_output, step.output_count);
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
        PublishedOutput& output = published[k];
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

/// Asks for the cache lines of a node's ports and first parameters, a few steps before they are needed: nodes are
/// scattered, and a thousand of them do not fit the nearest cache.
static void fetch_ahead(const Step* step, const Step* past) noexcept {
    constexpr std::ptrdiff_t distance = 4;
    if (past - step <= distance) return;
    const auto* node = static_cast<const std::byte*>(step[distance].node);
    __builtin_prefetch(node + 64);
    __builtin_prefetch(node + 128);
}

template <bool hashed>
void GroupRuntime::run_each(const Tick& tick) noexcept {
    const Step* const past = steps.data() + steps.size();
    for (const Step& step : steps) {
        fetch_ahead(&step, past);
        if (step.one_at_a_time && tick.frames > 1) {
            run_one_at_a_time(step, wires[static_cast<std::size_t>(&step - steps.data())], tick);
        } else {
            if (step.driven) drive(wires[static_cast<std::size_t>(&step - steps.data())], 0);
            step.process(step.node, tick);
        }
        if constexpr (hashed) hash_outputs(step, tick.frames);
    }
}

void GroupRuntime::run_steps(int frames) noexcept {
    const Flicks elapsed = last_ < 0 ? plan->period : (next_ - last_) * plan->period;
    const Tick tick{next_, plan->period, elapsed, frames};
    if (hashes_outputs) run_each<true>(tick);
    else run_each<false>(tick);
    ran_ += frames;
}

std::uint64_t GroupRuntime::hash_of(std::size_t k) const {
    const PublishedOutput& output = published[k];
    return output.is_signal ? output.samples.value(static_cast<std::uint64_t>(ran_)) : output.hash.value();
}

void GroupRuntime::publish(int frames, Pace pace) noexcept {
    std::size_t took = 0;
    for (Link* link : outputs) {
        const auto id = static_cast<std::uint16_t>(link->id);
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
    for (Output* output : snapshots) output->last_was_dropped = took == 0 && !outputs.empty();
}

int GroupRuntime::call(int frames, Pace pace) noexcept {
    const int n = cut(plan->has_audio ? frames : 1);
    now = next_ * plan->period;
    acquire(pace);
    {
        RealtimeScope scope;
        read_links(n, pace);
        for (Output* output : snapshots) {
            output->oldest_readable = std::numeric_limits<std::int64_t>::max();
            for (const Link* link : outputs)
                output->oldest_readable = std::min(output->oldest_readable, link->oldest_version(output));
        }
        for (DelayLine& delay : delays)
            for (int i = 0; i < n; ++i)
                std::memcpy(
                    delay.delayed.data() + static_cast<std::size_t>(i) * delay.type->size,
                    delay.history.data() + static_cast<std::size_t>((next_ + i) % delay.count) * delay.type->size,
                    delay.type->size);
        run_steps(n);
        for (DelayLine& delay : delays)
            for (int i = 0; i < n; ++i)
                std::memcpy(
                    delay.history.data() + static_cast<std::size_t>((next_ + i) % delay.count) * delay.type->size,
                    delay.source->data + i * delay.source->stride, delay.type->size);
        publish(n, pace);
    }
    for (DeviceSlot* slot : devices) {
        if (!slot->port.has_output) continue;
        telemetry.force_N.store(glm::length(slot->port.wrench.force), std::memory_order_relaxed);
        if (!replayed) slot->device->commit(slot->port.wrench);
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
}

}  // namespace tactus

// SPDX-License-Identifier: Apache-2.0
// The nodes of a rate group, one after the other.
#include "dsp/core/clock.hpp"
#include "engine/observe/observed_port.hpp"
#include "engine/run/group_runtime.hpp"
#include "graph/node/node_memory.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tactus::run {

void GroupRuntime::move_ports(std::size_t step, int by, int to, int frames) noexcept {
    const build::Step& moved = program_->steps[step];
    for (Input* input : program_->wires[step].inputs) {
        // A batch from another group belongs to the first activation of a call.
        if (input->kind == InputKind::batch && input->times != &now) input->count = 0;
        else input->data += by * input->stride;
    }
    for (const LinkWire* wire : program_->wires[step].batches) {
        Input& input = *wire->target;
        input.data += static_cast<std::size_t>(input.count) * wire->type->size;
        input.times += input.count;
        input.count = to < frames ? wire->batch_counts[static_cast<std::size_t>(to)] : 0;
    }
    const bool may_hold = (moved.one_at_a_time || moved.driven) && to < frames;
    for (std::uint32_t k = moved.first_output; k < moved.first_output + moved.output_count; ++k) {
        Output& output = *program_->published[k].port;
        const std::byte* const last = output.data + (by - 1) * output.stride;
        output.data += by * output.stride;
        if (may_hold && output.type != &value::event) std::memcpy(output.data, last, output.type->size);
    }
}

/// An output keeps its value until the node writes it: the last of a call is the first of the next.
void GroupRuntime::hold_outputs(int frames) noexcept {
    if (frames == 1) return;
    for (const build::Step& step : program_->steps) {
        if (!step.one_at_a_time && !step.driven) continue;
        for (std::uint32_t k = step.first_output; k < step.first_output + step.output_count; ++k) {
            const Output& output = *program_->published[k].port;
            if (output.type == &value::event) continue;
            std::memcpy(output.data, output.data + (frames - 1) * output.stride, output.type->size);
        }
    }
}

void GroupRuntime::clear_events(int frames) noexcept {
    for (const Output* output : program_->event_outputs)
        for (int i = 0; i < frames; ++i) {
            auto& events = *reinterpret_cast<Events*>(output->data + i * output->stride);
            if (events.lost > 0) telemetry.lost_events.fetch_add(events.lost, std::memory_order_relaxed);
            events.clear();
        }
}

void GroupRuntime::drive(const build::StepWires& wires, int activation) noexcept {
    for (const build::Drive& drive : wires.drives) drive.apply(activation);
    for (build::EventMerge* merge : wires.events)
        if (const int lost = merge->gather(activation); lost > 0)
            telemetry.lost_events.fetch_add(lost, std::memory_order_relaxed);
}

void GroupRuntime::move_back(std::size_t step, int frames) noexcept {
    const build::Step& moved = program_->steps[step];
    for (Input* input : program_->wires[step].inputs)
        if (input->kind != InputKind::batch || input->times == &now) input->data -= frames * input->stride;
    for (std::uint32_t k = moved.first_output; k < moved.first_output + moved.output_count; ++k)
        program_->published[k].port->data -= frames * program_->published[k].port->stride;
}

void GroupRuntime::run_part(std::size_t at, const Tick& part, int from, int frames) noexcept {
    const build::Step& step = program_->steps[at];
    if (!step.driven && !(step.one_at_a_time && part.frames > 1)) {
        const Flicks start = std::exchange(now, part.index * part.period);
        step.process(step.node, part);
        move_ports(at, part.frames, from + part.frames, frames);
        now = start;
        return;
    }
    const Flicks start = now;
    for (int i = 0; i < part.frames; ++i) {
        drive(program_->wires[at], from + i);
        now = (part.index + i) * part.period;
        step.process(step.node, {part.index + i, part.period, i == 0 ? part.elapsed : part.period, 1});
        move_ports(at, 1, from + i + 1, frames);
    }
    now = start;
}

void GroupRuntime::run_one_at_a_time(std::size_t step, const Tick& all) noexcept {
    run_part(step, all, 0, all.frames);
    move_back(step, all.frames);
}

void GroupRuntime::run_cycle(const build::Stretch& stretch, const Tick& all, bool timed) noexcept {
    build::GroupProgram& program = *program_;
    const std::size_t past = stretch.first + stretch.count;
    for (int from = 0; from < all.frames;) {
        const int count = std::min(stretch.longest, all.frames - from);
        const Tick part{all.index + from, all.period, from == 0 ? all.elapsed : all.period, count};
        for (build::DelayLine* line : stretch.inner) line->recall(part.index, from, count);
        std::int64_t began = timed ? steady_ns() : 0;
        for (std::size_t step = stretch.first; step < past; ++step) {
            run_part(step, part, from, all.frames);
            if (!timed) continue;
            const std::int64_t now_ns = steady_ns();
            program.wires[step].spent_ns += now_ns - began;
            began = now_ns;
        }
        for (build::DelayLine* line : stretch.inner) line->remember(part.index, from, count);
        from += count;
    }
    for (std::size_t step = stretch.first; step < past; ++step) {
        move_back(step, all.frames);
        if (program.hashes_outputs) hash_outputs(program.steps[step], all.frames);
        if (program.records_outputs) record_outputs(program.steps[step], all.frames);
        if (timed) program.wires[step].time->add(std::exchange(program.wires[step].spent_ns, 0));
    }
}

void GroupRuntime::hash_outputs(const build::Step& step, int frames) noexcept {
    const auto position = static_cast<std::uint64_t>(ran_);
    for (std::uint32_t k = step.first_output; k < step.first_output + step.output_count; ++k) {
        build::PublishedOutput& output = program_->published[k];
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

void GroupRuntime::record_outputs(const build::Step& step, int frames) noexcept {
    for (std::uint32_t k = step.first_output; k < step.first_output + step.output_count; ++k) {
        build::PublishedOutput& output = program_->published[k];
        if (recorded_) put_into_frames(output, frames);
        if (output.seen)
            output.seen->see(next_, output.port->data, static_cast<std::size_t>(frames), output.port->stride);
    }
}

void GroupRuntime::put_into_frames(const build::PublishedOutput& output, int frames) noexcept {
    const std::size_t size = output.port->type->size;
    std::byte* to = program_->frames.data() + output.offset;
    for (int i = 0; i < frames; ++i, to += program_->layout.bytes)
        std::memcpy(to, output.port->data + i * output.port->stride, size);
}

/// Asks for the cache line of a node's ports and first parameters, a few steps before they are needed: nodes are
/// scattered, and a thousand of them do not fit the nearest cache.
static void fetch_ahead(const build::Step* step, const build::Step* past) noexcept {
    constexpr std::ptrdiff_t distance = 4;
    if (past - step <= distance) return;
    __builtin_prefetch(static_cast<const std::byte*>(step[distance].node) + (cache_line - node_offset));
}

template <bool watched>
void GroupRuntime::run_each(const build::Stretch& stretch, const Tick& tick, bool timed) noexcept {
    const build::GroupProgram& program = *program_;
    const build::Step* const begin = program.steps.data();
    const build::Step* const past = begin + stretch.first + stretch.count;
    [[maybe_unused]] std::int64_t began = watched && timed ? steady_ns() : 0;
    for (const build::Step* step = begin + stretch.first; step < past; ++step) {
        fetch_ahead(step, past);
        if (!step->driven && !(step->one_at_a_time && tick.frames > 1)) {
            step->process(step->node, tick);
        } else if (tick.frames == 1) {
            drive(program.wires[static_cast<std::size_t>(step - begin)], 0);
            step->process(step->node, tick);
        } else {
            run_one_at_a_time(static_cast<std::size_t>(step - begin), tick);
        }
        if constexpr (watched) {
            if (program.hashes_outputs) hash_outputs(*step, tick.frames);
            if (program.records_outputs) record_outputs(*step, tick.frames);
            if (!timed) continue;
            const std::int64_t now_ns = steady_ns();
            program.wires[static_cast<std::size_t>(step - begin)].time->add(now_ns - began);
            began = now_ns;
        }
    }
}

void GroupRuntime::run_steps(int frames) noexcept {
    const Flicks elapsed = last_ < 0 ? plan->period : (next_ - last_) * plan->period;
    const Tick tick{next_, plan->period, elapsed, frames};
    const bool timed = times_nodes && (calls_++ % timed_every == 0 || closely_ > 0);
    closely_ = std::max(closely_ - 1, 0);
    recorded_ = program_->recorded.load(std::memory_order_acquire);
    const bool watched = timed || program_->hashes_outputs || program_->records_outputs;
    for (const build::Stretch& stretch : program_->stretches) {
        for (build::DelayLine* line : stretch.before) line->recall(next_, 0, frames);
        if (stretch.longest > 0) run_cycle(stretch, tick, timed);
        else if (watched) run_each<true>(stretch, tick, timed);
        else run_each<false>(stretch, tick, false);
    }
    for (const build::Stretch& stretch : program_->stretches)
        for (build::DelayLine* line : stretch.before) line->remember(next_, 0, frames);
    if (recorded_)
        recorded_->write(next_, program_->frames.data(), static_cast<std::size_t>(frames),
                         static_cast<std::ptrdiff_t>(program_->layout.bytes));
    ran_ += frames;
}

}  // namespace tactus::run
